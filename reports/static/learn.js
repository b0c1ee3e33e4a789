/* The paper's block by its closed forms, and the wall over friction. The same formulas stand in reports/learn.py. */
(() => {
  "use strict";
  const answers = (rear, front) => {
    const ends = [front, rear / (1 + 0.5 * (rear - front))];
    const springs = (0.5 * (rear + front)) / (1 + 0.25 * (rear - front));
    const outer = 0.25 * springs;
    return {
      least: Math.min(...ends),
      greatest: Math.max(...ends),
      springs,
      shares: [0.25 - outer, 0.25, 0.25, 0.25 + outer],
    };
  };
  window.blockAnswers = answers;

  const byId = (id) => document.getElementById(id);
  const text = (id, value) => { byId(id).textContent = value; };
  const set = (id, values) => Object.entries(values).forEach(([name, value]) => byId(id).setAttribute(name, value));
  const at = (value) => 40 + 480 * value;
  const line = byId("line");

  const update = () => {
    const [rear, front] = [Number(byId("rear").value), Number(byId("front").value)];
    const stiffness = 10 ** Number(byId("stiffness").value);
    const found = answers(rear, front);
    text("rear-value", rear.toFixed(2));
    text("front-value", front.toFixed(2));
    text("stiffness-value", Number(stiffness.toPrecision(2)));
    for (const name of ["least", "greatest", "springs"]) text(name, found[name].toFixed(4));
    const width = Math.max(480 * (found.greatest - found.least), 2);
    set("la-range", { x: at(found.least), width });
    set("de-band", { x: at(found.least), width });
    set("fe-point", { transform: `translate(${at(found.springs)} 60)` });
    line.setAttribute("aria-label", `Limit analysis from ${found.least.toFixed(3)} to ${found.greatest.toFixed(3)}, springs ${found.springs.toFixed(3)}`);
    found.shares.forEach((share, k) => set(`spring-${k}`, { d: arrow(k, share) }));
    /* Springs give in by share / stiffness of the block's length, drawn as it is; the multiplier does not change. */
    const [sink, lean] = [0.25 / stiffness, (found.shares[3] - found.shares[0]) / stiffness];
    set("stone", { transform: `rotate(${(Math.atan(lean) * 180) / Math.PI} 200 150) translate(0 ${400 * sink})` });
    text("sink", `${(100 * sink).toPrecision(2)} % of its length`);
  };
  const arrow = (k, share) => {
    const x = [8, 192, 208, 392][k];
    const length = 260 * share;
    return `M${x} ${256 + length}V262M${x - 7} 268L${x} 254L${x + 7} 268z`;
  };
  ["rear", "front", "stiffness"].forEach((id) => byId(id).addEventListener("input", update));
  update();

  const frictions = JSON.parse(byId("data").textContent).frictions;
  const steps = [...document.querySelectorAll(".step")];
  const slider = byId("friction");
  const show = () => {
    text("friction-value", frictions[Number(slider.value)]);
    steps.forEach((step, k) => { step.hidden = k !== Number(slider.value); });
  };
  document.querySelectorAll(".tools").forEach((tools) => { tools.hidden = false; });
  slider.addEventListener("input", show);
  show();
  window.addEventListener("beforeprint", () => steps.forEach((step) => { step.hidden = false; }));
  window.addEventListener("afterprint", show);
})();
