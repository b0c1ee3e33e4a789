/* Draws mechanisms and contact forces from the numbers in the page. Text goes in as text only, never as markup. */
(() => {
  "use strict";
  const NS = "http://www.w3.org/2000/svg";
  const FORCE_STEPS = 10000;
  const MOST_LABELS = 45;
  const REACH = 500; /* displacement of the fastest vertex at amplitude 1, an eighth of the longer side */
  const STATES = { k: "stick", s: "slide", r: "rock", b: "rock and slide", o: "open", d: "dilatant slip" };
  const CLASSES = { s: "slide", r: "rock", b: "both", o: "open", d: "dilatant" };
  const HEAVY = "sbd";
  const cases = JSON.parse(document.getElementById("data").textContent);
  const drawn = new WeakMap();

  const make = (name, attributes, parent) => {
    const element = document.createElementNS(NS, name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    parent.appendChild(element);
    return element;
  };
  const at = (list, index) => list[list.length === 1 ? 0 : index];
  const end = (wall, p, k) => [wall.e[4 * p + 2 * k], wall.e[4 * p + 2 * k + 1]];
  const centre = (wall, i) => [wall.c[2 * i], wall.c[2 * i + 1]];
  const digits = (value) => {
    if (value === 0) return "0";
    const size = Math.abs(value);
    const text = size >= 1e-3 && size < 1e6 ? String(Number(value.toPrecision(3))) : value.toExponential(2);
    return text.replace("-", "−");
  };

  /* Motion of block i at amplitude k, linear in k: no vertex leaves the line of its velocity. */
  const matrix = (wall, result, i, k) => {
    const [dx, dy, turn] = [result.m[3 * i] / 10, result.m[3 * i + 1] / 10, (result.m[3 * i + 2] / 1e4) * k];
    const [x, y] = centre(wall, i);
    return `matrix(1 ${turn} ${-turn} 1 ${k * dx + turn * y} ${k * dy - turn * x})`;
  };
  const velocity = (wall, result, i, point) => {
    const [x, y] = centre(wall, i);
    const turn = result.m[3 * i + 2] / 1e4;
    return [result.m[3 * i] / 10 - turn * (point[1] - y), result.m[3 * i + 1] / 10 + turn * (point[0] - x)];
  };
  const opening = (wall, result, p, k) => {
    const point = end(wall, p, k);
    const [a, b] = [velocity(wall, result, wall.a[p], point), velocity(wall, result, wall.b[p], point)];
    return ((b[0] - a[0]) * wall.n[2 * p] + (b[1] - a[1]) * wall.n[2 * p + 1]) / 1000;
  };
  const tangent = (wall, p) => {
    const [[x0, y0], [x1, y1]] = [end(wall, p, 0), end(wall, p, 1)];
    const length = Math.hypot(x1 - x0, y1 - y0) || 1;
    return [(x1 - x0) / length, (y1 - y0) / length];
  };
  const slip = (wall, result, p) => {
    const point = end(wall, p, 0);
    const [a, b] = [velocity(wall, result, wall.a[p], point), velocity(wall, result, wall.b[p], point)];
    const t = tangent(wall, p);
    return (b[0] - a[0]) * t[0] + (b[1] - a[1]) * t[1];
  };

  const amplitudeOf = (section) => {
    const slider = section.querySelector("input[type=range]");
    return slider ? Number(slider.value) / 100 : 1;
  };

  const drawMechanism = (svg, wall, result) => {
    make("path", { class: "ghost", d: wall.path.join("") }, svg);
    const movers = [];
    wall.path.forEach((d, i) => {
      const still = !result.m[3 * i] && !result.m[3 * i + 1] && !result.m[3 * i + 2];
      const kind = wall.fixed[i] === "1" ? "held" : still ? "still" : "moves";
      const path = make("path", { class: kind, d, "data-block": i }, svg);
      if (!still) movers.push([path, i]);
    });
    const size = Math.min(46, Math.max(8, 0.07 * wall.block));
    if (result.s) {
      [...result.s].forEach((letter, p) => {
        if (letter === "k") return;
        const [[x0, y0], [x1, y1]] = [end(wall, p, 0), end(wall, p, 1)];
        const group = make("g", { class: CLASSES[letter], "data-joint": p }, svg);
        const d = `M${x0} ${y0}L${x1} ${y1}`;
        const line = make("path", { d, "stroke-width": HEAVY.includes(letter) ? size : 0.6 * size }, group);
        if (letter === "d") make("path", { class: "core", d, "stroke-width": 0.4 * size }, group);
        if (letter === "o") line.setAttribute("stroke-dasharray", `${0.9 * size} ${0.9 * size}`);
        if (letter === "r" || letter === "b") {
          const hinge = opening(wall, result, p, 0) <= opening(wall, result, p, 1) ? [x0, y0] : [x1, y1];
          make("circle", { cx: hinge[0], cy: hinge[1], r: 1.1 * size }, group);
        }
        movers.push([group, wall.a[p]]);
      });
    }
    return (k) => movers.forEach(([element, i]) => element.setAttribute("transform", matrix(wall, result, i, k)));
  };

  /* A resultant as an arrow to where it is passed on downwards, or to the right; it ends at a support, never within. */
  const arrow = (wall, p, point, way, held) => {
    const up = way[1] < -1e-9 || (Math.abs(way[1]) <= 1e-9 && way[0] < 0);
    const down = up ? [-way[0], -way[1]] : way;
    const sign = held[0] ? 1 : -1;
    const leaves = sign * (down[0] * wall.n[2 * p] + down[1] * wall.n[2 * p + 1]) > 0;
    const half = 0.36 * wall.block;
    const anchored = held[0] || held[1];
    const [before, after] = anchored ? (leaves ? [0, 2 * half] : [2 * half, 0]) : [half, half];
    const at = (length) => [point[0] + length * down[0], point[1] + length * down[1]];
    return { tail: at(-before), tip: at(after), down };
  };
  const forceScale = (svg, wall, largest, size) => {
    if (!largest) return;
    const real = (largest * wall.unit) / FORCE_STEPS;
    const power = 10 ** Math.floor(Math.log10(real));
    const round = Math.max(...[1, 2, 5].map((head) => head * power).filter((force) => force <= real * (1 + 1e-9)));
    const [left, , width, bottom] = wall.box.split(" ").map(Number);
    const [x, y] = [left + width - 900, bottom + Number(wall.box.split(" ")[1]) - 90];
    const group = make("g", { class: "scale" }, svg);
    make("path", { d: `M${x - 330} ${y}H${x}`, "stroke-width": Math.max(0.02 * wall.block, (0.16 * wall.block * round) / real) }, group);
    make("text", { x: x + 60, y: y + 0.35 * size, "font-size": size }, group).textContent = `${digits(round)} ${wall.force === "1" ? "" : wall.force}`;
  };

  const drawForces = (svg, wall, result) => {
    make("path", { class: "outline held", d: wall.path.filter((_, i) => wall.fixed[i] === "1").join("") }, svg);
    make("path", { class: "outline", d: wall.path.filter((_, i) => wall.fixed[i] !== "1").join("") }, svg);
    const bars = make("g", { class: "bars" }, svg);
    const lines = make("g", { class: "thrust" }, svg);
    let largest = 0;
    for (let p = 0; p < wall.a.length; p++) {
      largest = Math.max(largest, Math.hypot(result.f[3 * p] + result.f[3 * p + 1], result.f[3 * p + 2]));
    }
    const pressure = (p) => {
      const share = result.f[3 * p + 1] / (result.f[3 * p] + result.f[3 * p + 1]);
      const [[x0, y0], [x1, y1]] = [end(wall, p, 0), end(wall, p, 1)];
      return [x0 + share * (x1 - x0), y0 + share * (y1 - y0)];
    };
    const carries = (p) => {
      const normal = result.f[3 * p] + result.f[3 * p + 1];
      return normal > 0 && Math.hypot(normal, result.f[3 * p + 2]) >= 0.002 * largest;
    };
    const touching = wall.ids.map(() => []);
    for (let p = 0; p < wall.a.length; p++) {
      if (carries(p)) [wall.a[p], wall.b[p]].forEach((block) => touching[block].push(p));
    }
    /* A block with exactly two forces passes the thrust straight on; else the lines meet at its centroid. */
    const junction = (block) => {
      if (touching[block].length !== 2) return centre(wall, block);
      const [[x0, y0], [x1, y1]] = touching[block].map(pressure);
      return [(x0 + x1) / 2, (y0 + y1) / 2];
    };
    const letters = Math.min(110, 0.17 * wall.block);
    const labelled = wall.a.filter((_, p) => carries(p)).length <= MOST_LABELS;
    forceScale(svg, wall, largest, Math.min(110, Math.max(80, letters)));
    for (let p = 0; p < wall.a.length; p++) {
      const [n1, n2, s] = [result.f[3 * p], result.f[3 * p + 1], result.f[3 * p + 2]];
      const normal = n1 + n2;
      const force = Math.hypot(normal, s);
      if (!carries(p)) continue;
      const [x, y] = pressure(p);
      const t = tangent(wall, p);
      const held = [wall.a[p], wall.b[p]].map((block) => wall.fixed[block] === "1");
      const way = [
        (normal * wall.n[2 * p] / 1000 + s * t[0]) / force,
        (normal * wall.n[2 * p + 1] / 1000 + s * t[1]) / force,
      ];
      const width = Math.max(0.02 * wall.block, (0.16 * wall.block * force) / largest);
      const size = Math.max(0.2 * wall.block, 1.7 * width);
      const full = result.used[p] === 100;
      const group = make("g", { class: full ? "full" : "partly", "data-joint": p }, bars);
      const { tail, tip, down } = arrow(wall, p, [x, y], way, held);
      const neck = [tip[0] - size * down[0], tip[1] - size * down[1]];
      const side = [-0.4 * size * down[1], 0.4 * size * down[0]];
      make("path", {
        d: `M${tail[0]} ${tail[1]}L${0.3 * tip[0] + 0.7 * neck[0]} ${0.3 * tip[1] + 0.7 * neck[1]}`,
        "stroke-width": width,
      }, group);
      make("path", {
        class: "tip-of",
        d: `M${tip[0]} ${tip[1]}L${neck[0] + side[0]} ${neck[1] + side[1]}L${neck[0] - side[0]} ${neck[1] - side[1]}z`,
      }, group);
      if (labelled) {
        const level = Math.abs(wall.n[2 * p + 1]) > 500;
        const text = make("text", {
          x: x + (level ? 0.09 * wall.block : 0), y: y - (level ? 0.05 : 0.1) * wall.block,
          "font-size": letters, "text-anchor": level ? "start" : "middle",
        }, group);
        text.textContent = digits(force * wall.unit / FORCE_STEPS);
      }
      if (full) make("circle", { cx: x, cy: y, r: Math.max(0.05 * wall.block, 0.5 * width + 9) }, group);
      const [from, to] = [wall.a[p], wall.b[p]].map((block, k) => (held[k] ? [x, y] : junction(block)));
      make("path", {
        d: `M${from[0]} ${from[1]}L${x} ${y}L${to[0]} ${to[1]}`,
        "stroke-width": width,
        "data-joint": p,
      }, lines);
    }
    return () => {};
  };

  const draw = (svg) => {
    if (drawn.has(svg)) return;
    const wall = cases[Number(svg.dataset.case)];
    const result = wall.results[Number(svg.dataset.result)];
    const mechanism = svg.dataset.kind === "mechanism";
    if (mechanism ? !result.m : !result.f) return;
    const update = (mechanism ? drawMechanism : drawForces)(svg, wall, result);
    drawn.set(svg, update);
    update(amplitudeOf(svg.closest("section")));
  };

  /* Room for what moves further than the drawing's margin, so that no block leaves the picture. */
  const widen = (svg, k) => {
    const [x, y, width, height] = cases[Number(svg.dataset.case)].box.split(" ").map(Number);
    const room = Math.max(0, k - 1) * REACH;
    svg.setAttribute("viewBox", `${x - room} ${y - room} ${width + 2 * room} ${height + 2 * room}`);
  };

  const figures = [...document.querySelectorAll("svg[data-kind]")];
  if ("IntersectionObserver" in window) {
    const watcher = new IntersectionObserver((entries) => {
      for (const entry of entries) {
        if (!entry.isIntersecting) continue;
        watcher.unobserve(entry.target);
        draw(entry.target);
      }
    }, { rootMargin: "800px" });
    figures.forEach((svg) => watcher.observe(svg));
  } else {
    figures.forEach(draw);
  }
  window.addEventListener("beforeprint", () => figures.forEach(draw));

  for (const section of document.querySelectorAll("section.case")) {
    section.querySelectorAll(".tools").forEach((tools) => { tools.hidden = false; });
    const slider = section.querySelector("input[type=range]");
    if (slider) {
      const output = section.querySelector("output");
      slider.addEventListener("input", () => {
        output.textContent = `${slider.value} %`;
        for (const svg of section.querySelectorAll("svg[data-kind=mechanism]")) {
          if (drawn.has(svg)) drawn.get(svg)(Number(slider.value) / 100);
          widen(svg, Number(slider.value) / 100);
        }
      });
    }
    for (const radio of section.querySelectorAll("input[type=radio]")) {
      radio.addEventListener("change", () => {
        if (radio.checked) section.dataset.layer = radio.value;
      });
    }
  }

  /* Sections far off have an estimated height until they are laid out, so a jump is corrected as they come near. */
  const settle = () => {
    const target = location.hash.length > 1 ? document.getElementById(location.hash.slice(1)) : null;
    if (!target) return;
    let left = 8;
    const correct = () => {
      if (Math.abs(target.getBoundingClientRect().top) > 2) target.scrollIntoView({ behavior: "instant" });
      if (--left > 0) requestAnimationFrame(correct);
    };
    requestAnimationFrame(correct);
  };
  window.addEventListener("hashchange", settle);
  document.addEventListener("click", (event) => {
    const link = event.target instanceof Element ? event.target.closest("a[href^='#']") : null;
    if (link && link.getAttribute("href") === location.hash) settle();
  });
  settle();

  /* Values of the block or interface under the pointer. */
  const tip = document.createElement("div");
  tip.className = "tip";
  tip.hidden = true;
  tip.setAttribute("aria-hidden", "true");
  document.body.appendChild(tip);
  const blockText = (wall, result, i) => {
    const v = [0, 1].map((k) => result.m[3 * i + k] * result.speed * (k ? -1 : 1));
    const omega = -result.m[3 * i + 2] * result.spin;
    return [`block ${wall.ids[i]}`, `u = (${digits(v[0])}, ${digits(v[1])})`, `ω = ${digits(omega)}`];
  };
  const jointText = (wall, result, p, mechanism) => {
    const head = `${wall.ids[wall.a[p]]} | ${wall.ids[wall.b[p]]}`;
    const lines = [head, `${at(wall.joint, p)} joint, tan φ = ${digits(at(wall.mu, p))}`];
    if (mechanism) {
      const unit = result.speed * 10;
      const open = [0, 1].map((k) => digits(opening(wall, result, p, k) * unit));
      lines.push(STATES[result.s[p]], `opening ${open.join(", ")}; slip ${digits(slip(wall, result, p) * unit)}`);
    } else {
      const unit = wall.unit / FORCE_STEPS;
      const [n1, n2, s] = [0, 1, 2].map((k) => result.f[3 * p + k] * unit);
      lines.push(`n₁ = ${digits(n1)}, n₂ = ${digits(n2)} ${wall.force}`, `s = ${digits(s)} ${wall.force}`);
      if (result.used[p] >= 0) lines.push(`friction used: ${result.used[p]} %`);
    }
    return lines;
  };
  document.addEventListener("pointerover", (event) => {
    const target = event.target instanceof Element ? event.target.closest("[data-block],[data-joint]") : null;
    const svg = target && target.closest("svg[data-kind]");
    if (!svg) {
      tip.hidden = true;
      return;
    }
    const wall = cases[Number(svg.dataset.case)];
    const result = wall.results[Number(svg.dataset.result)];
    const lines = target.dataset.block !== undefined
      ? blockText(wall, result, Number(target.dataset.block))
      : jointText(wall, result, Number(target.dataset.joint), svg.dataset.kind === "mechanism");
    tip.replaceChildren(...lines.map((line) => {
      const row = document.createElement("div");
      row.textContent = line;
      return row;
    }));
    tip.hidden = false;
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
