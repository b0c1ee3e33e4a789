/* Unpacks drawings, moves the blocks of mechanisms, chooses the layer of forces and says the values of what is under the pointer. */
(() => {
  "use strict";
  const REACH = 500; /* displacement of the fastest vertex at amplitude 1, an eighth of the longer side */
  const cases = JSON.parse(document.getElementById("data").textContent);

  /* Puts a drawing that is packed into its place; nothing until all are unpacked. */
  let fill = () => {};
  const unpack = async (text) => {
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    const contents = JSON.parse(await new Response(stream).text());
    fill = (svg) => {
      if (svg.dataset.packed === undefined) return;
      svg.innerHTML = contents[svg.dataset.packed];
      delete svg.dataset.packed;
    };
    const figures = [...document.querySelectorAll("svg[data-packed]")];
    const watcher = new IntersectionObserver((entries) => {
      entries.filter((entry) => entry.isIntersecting).forEach((entry) => fill(entry.target));
    }, { rootMargin: "800px" });
    figures.forEach((svg) => watcher.observe(svg));
    window.addEventListener("beforeprint", () => figures.forEach(fill));
    document.getElementById("packed").dataset.unpacked = ""; // from here on, what is printed is complete
  };
  const packed = document.getElementById("packed");
  if (packed) unpack(packed.textContent);

  /* A function that moves the groups of a drawing: what stands in the page is their displacement at amplitude 1. */
  const mover = (svg) => {
    const groups = [...svg.querySelectorAll("[transform]")].map((group) => {
      const { a, b, c, d, e, f } = group.transform.baseVal.consolidate().matrix;
      return [group, [a - 1, b, c, d - 1, e, f]];
    });
    /* What lies between the faces of a joint opens from a line: both are a point and steps from it, as numbers. */
    const steps = (data) => data.split("M").slice(1).map((line) => line.match(/-?\d+/g).map(Number));
    const cracks = [...svg.querySelectorAll("[data-rest]")].map((crack) => [crack, steps(crack.dataset.rest), steps(crack.getAttribute("d"))]);
    const { x, y, width, height } = svg.viewBox.baseVal;
    const box = [x, y, width, height];
    return (k) => {
      for (const [group, [a, b, c, d, e, f]] of groups) {
        group.setAttribute("transform", `matrix(${[1 + k * a, k * b, k * c, 1 + k * d, k * e, k * f].join(" ")})`);
      }
      for (const [crack, rest, open] of cracks) {
        const placed = open.map((corners, i) => {
          const [x, y, across, up] = rest[i];
          return [x, y, across, up, 0, 0, -across, -up].map((from, j) => (j === 2 ? "l" : " ") + (from + k * (corners[j] - from)));
        });
        crack.setAttribute("d", placed.map((corners) => `M${corners.join("")}z`).join(""));
      }
      /* Room for what moves further than the margin of the drawing. */
      const room = Math.max(0, k - 1) * REACH;
      svg.setAttribute("viewBox", [box[0] - room, box[1] - room, box[2] + 2 * room, box[3] + 2 * room].join(" "));
    };
  };

  const still = matchMedia("(prefers-reduced-motion: reduce)");
  for (const section of document.querySelectorAll("[data-case]")) {
    section.querySelectorAll(".tools, .play").forEach((tools) => { tools.hidden = false; });
    const slider = section.querySelector("input[type=range]");
    let movers;
    const amplitude = (percent) => {
      movers ??= [...section.querySelectorAll("[data-kind=mechanism] svg")].map((svg) => (fill(svg), mover(svg)));
      movers.forEach((move) => move(percent / 100));
      if (!slider) return;
      slider.value = percent;
      section.querySelector("output").textContent = `${Math.round(percent)} %`;
    };
    if (slider) slider.addEventListener("input", () => amplitude(Number(slider.value)));
    /* The mechanism grows from rest and returns, until it is stopped; then it stands as it is drawn. */
    const play = section.querySelector(".play");
    let frame = 0;
    const stop = () => {
      cancelAnimationFrame(frame);
      frame = 0;
      play.setAttribute("aria-pressed", "false");
      amplitude(100);
    };
    if (play) play.addEventListener("click", () => {
      if (frame) { stop(); return; }
      if (still.matches) return;
      play.setAttribute("aria-pressed", "true");
      const began = performance.now();
      const step = (now) => {
        amplitude(50 * (1 - Math.cos((now - began) / 800)));
        frame = requestAnimationFrame(step);
      };
      frame = requestAnimationFrame(step);
    });
    if (play) still.addEventListener("change", () => { if (still.matches && frame) stop(); });
    for (const radio of section.querySelectorAll("input[type=radio]")) {
      radio.addEventListener("change", () => {
        if (radio.checked) section.dataset.layer = radio.value;
      });
    }
  }

  /* A link opens what its target is folded into. Sections far off have an estimated height until they are laid out, so
     a jump is corrected as they come near. */
  const settle = () => {
    const target = location.hash.length > 1 ? document.getElementById(location.hash.slice(1)) : null;
    if (!target) return;
    for (let fold = target.closest("details"); fold; fold = fold.parentElement.closest("details")) fold.open = true;
    const below = Number.parseFloat(getComputedStyle(document.documentElement).scrollPaddingTop) || 0;
    let left = 8;
    const correct = () => {
      if (Math.abs(target.getBoundingClientRect().top - below) > 2) target.scrollIntoView({ behavior: "instant" });
      if (--left > 0) requestAnimationFrame(correct);
    };
    requestAnimationFrame(correct);
  };
  window.addEventListener("hashchange", settle);
  document.addEventListener("click", (event) => {
    const inside = event.target instanceof Element ? event.target : null;
    document.querySelectorAll("nav details[open]").forEach((menu) => { if (!inside || inside.closest("a") || !menu.contains(inside)) menu.open = false; });
    const link = inside ? inside.closest("a[href^='#']") : null;
    if (link && link.getAttribute("href") === location.hash) settle();
  });
  settle();

  /* Folded parts that belong on paper are open while the page prints. */
  const folds = [...document.querySelectorAll("details[data-print]:not([open])")];
  window.addEventListener("beforeprint", () => folds.forEach((fold) => { fold.open = true; }));
  window.addEventListener("afterprint", () => folds.forEach((fold) => { fold.open = false; }));

  /* Values of the block or interface under the pointer. */
  const tip = document.createElement("div");
  tip.className = "tip";
  tip.hidden = true;
  tip.setAttribute("aria-hidden", "true");
  document.body.appendChild(tip);
  const lines = (target, section, kind) => {
    const said = cases[Number(section.dataset.case)];
    const { block, joint, values } = target.dataset;
    const head = block !== undefined ? said.blocks[block] : said.joints[joint];
    const forms = block !== undefined ? said.moves : kind === "mechanism" ? said.joint : said.force;
    const left = (values || "").split("|");
    const rows = forms.map((form) => {
      const taken = left.splice(0, form.split("{}").length - 1);
      return taken.includes("") ? "" : form.replace(/\{\}/g, () => taken.shift());
    });
    return [...head.split("\n"), ...rows].filter(Boolean);
  };
  document.addEventListener("pointerover", (event) => {
    const target = event.target instanceof Element ? event.target.closest("[data-block],[data-joint]") : null;
    const figure = target && target.closest("[data-kind]");
    tip.hidden = !figure;
    if (!figure) return;
    tip.replaceChildren(...lines(target, figure.closest("[data-case]"), figure.dataset.kind).map((line) => {
      const row = document.createElement("div");
      row.textContent = line;
      return row;
    }));
  });
  document.addEventListener("pointermove", (event) => {
    if (tip.hidden) return;
    const [width, height] = [tip.offsetWidth, tip.offsetHeight];
    const left = Math.min(event.clientX + 14, document.documentElement.clientWidth - width - 4);
    const top = event.clientY + 18 + height > window.innerHeight ? event.clientY - height - 10 : event.clientY + 18;
    tip.style.left = `${Math.max(4, left)}px`;
    tip.style.top = `${top}px`;
  });
})();
