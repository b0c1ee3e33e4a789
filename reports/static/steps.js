/* Shows one step of a load path at a time: its place in the chart, the joint in a small drawing of the wall, and its name. */
(() => {
  "use strict";
  for (const list of document.querySelectorAll("ol.steps")) {
    const figure = list.closest("figure");
    const section = figure.closest("[data-case]");
    const [chart, spot] = [figure.querySelector("svg.chart"), figure.querySelector(".spot")];
    const wall = section.querySelector(".sheet svg.wall");
    const items = [...list.children];
    const places = items.map((item) => item.dataset.at.split(" ").map(Number));
    wall.id = `wall-${section.dataset.case}`;
    const { x, y, width, height } = wall.viewBox.baseVal;
    spot.setAttribute("viewBox", [x, y, width, height].join(" "));
    const copy = spot.querySelector("use");
    Object.entries({ x, y, width, height, href: `#${wall.id}` }).forEach(([name, value]) => copy.setAttribute(name, value));
    let shown = 0;
    const show = (wanted) => {
      shown = Math.max(0, Math.min(items.length - 1, wanted));
      items.forEach((item, number) => { item.hidden = number !== shown; });
      figure.querySelector(".here").setAttribute("d", `M${places[shown].join(" ")}h0`);
      figure.querySelector(".lit").setAttribute("d", items[shown].dataset.line);
    };
    list.setAttribute("aria-live", "polite");
    figure.classList.add("stepped");
    figure.tabIndex = 0;
    show(0);
    figure.addEventListener("keydown", (event) => {
      const to = { ArrowRight: shown + 1, ArrowLeft: shown - 1, Home: 0, End: items.length - 1 }[event.key];
      if (to === undefined) return;
      event.preventDefault();
      show(to);
    });
    chart.addEventListener("pointermove", (event) => {
      const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(chart.getScreenCTM().inverse());
      const far = places.map(([across, up]) => Math.hypot(across - at.x, up - at.y));
      show(far.indexOf(Math.min(...far)));
    });
  }
})();
