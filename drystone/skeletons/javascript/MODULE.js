// The associated maximum: the greatest multiplier at which forces in equilibrium stay within yield.
//
// A linear programme in the forces of the joints, solved by the simplex method on a dense tableau; its dual solution is
// the mechanism. Forces within friction are non-negative combinations of four vectors (n1, n2, s) a joint, (1, 0, +-mu)
// and (0, 1, +-mu). Sources: Livesley (1978) for the programme; Dantzig (1951) and Bland (1977) for the simplex method.
//
// It answers by lines: one JSON request a line on standard input, one result a line on standard output.
'use strict';
const readline = require('readline');

const ABOUT = {
  format: 'describe/1', name: 'NAME', version: '1.0', licence: 'MIT',
  title: 'associated maximum, in JavaScript', tolerance: 1e-7, most_blocks: 150,
  traits: { caption: 'associated maximum', bounds_above: true },
  settings: { pivots: { type: 'integer', default: 100000, minimum: 1, description: 'at most, before it gives up' } },
};
const ROUNDING = 1e-10; // of numbers of size 1: loads are divided by the weight of the wall, lengths by that of a joint

/** A tableau of min cost.x, columns x = right, x >= 0, with one artificial variable a row as its first basis. */
class Tableau {
  constructor(columns, right, mostPivots) {
    const m = right.length, n = columns.length;
    this.m = m; this.n = n; this.left = mostPivots;
    this.sign = right.map((value) => (value < 0 ? -1 : 1));
    this.rows = right.map((value, i) => {
      const row = new Float64Array(n + m + 1);
      for (let j = 0; j < n; j++) row[j] = this.sign[i] * columns[j][i];
      row[n + i] = 1;
      row[n + m] = this.sign[i] * value;
      return row;
    });
    this.basis = right.map((_, i) => n + i);
  }

  /** Reduced costs of all columns, the negative of the objective at their end. */
  reduced(cost) {
    const found = Float64Array.from({ length: this.n + this.m + 1 }, (_, j) => cost(j));
    this.rows.forEach((row, i) => {
      const c = cost(this.basis[i]);
      if (c) for (let j = 0; j < found.length; j++) found[j] -= c * row[j];
    });
    return found;
  }

  pivot(r, c, costs) {
    const row = this.rows[r], by = row[c];
    for (let j = 0; j < row.length; j++) row[j] /= by;
    for (const other of [...this.rows, costs]) {
      const factor = other[c];
      if (other !== row && factor !== 0) for (let j = 0; j < row.length; j++) other[j] -= factor * row[j];
    }
    this.basis[r] = c;
  }

  /** Go to the optimum over the first `open` columns; the column of a ray if there is none, else -1. */
  minimise(cost, open) {
    const costs = this.reduced(cost), last = this.n + this.m;
    let stalled = 0;
    for (;;) {
      let entering = -1;
      for (let j = 0; j < open; j++) {
        if (costs[j] < -ROUNDING && (entering < 0 || (stalled < 20 && costs[j] < costs[entering]))) entering = j;
      }
      if (entering < 0) { this.costs = costs; return -1; }
      let leaving = -1, least = Infinity; // of equal ratios the first by index, as Bland's rule needs when it stalls
      this.rows.forEach((row, i) => {
        const artificial = this.basis[i] >= this.n && open === this.n && Math.abs(row[entering]) > ROUNDING;
        if (row[entering] <= ROUNDING && !artificial) return;
        const ratio = artificial ? 0 : Math.max(row[last], 0) / row[entering];
        if (ratio < least || (ratio === least && this.basis[i] < this.basis[leaving])) { least = ratio; leaving = i; }
      });
      if (leaving < 0) return entering;
      if (this.left-- <= 0) throw new Error('it reached the number of pivots that the setting "pivots" allows');
      stalled = least === 0 ? stalled + 1 : 0;
      this.pivot(leaving, entering, costs);
    }
  }

  values() {
    const x = new Float64Array(this.n);
    this.rows.forEach((row, i) => { if (this.basis[i] < this.n) x[this.basis[i]] = row[this.n + this.m]; });
    return x;
  }

  /** Dual values of the rows: the costs of the artificial columns less their reduced costs. */
  duals(costOfArtificial) {
    return this.sign.map((sign, i) => sign * (costOfArtificial - this.costs[this.n + i]));
  }
}

function solve(wall, settings) {
  const { centroid, fixed, block_a: a, block_b: b, end1, end2, normal, friction, dead, live } = wall.metadata.arrays;
  const free = fixed.map((held, i) => (held ? -1 : i)).filter((i) => i >= 0);
  const place = new Map(free.map((i, k) => [i, 3 * k])), m = friction.length;
  const joint = end1.map((p, k) => Math.hypot(end2[k][0] - p[0], end2[k][1] - p[1]));
  const length = joint.reduce((sum, one) => sum + one, 0) / m;
  const size = (loads) => free.reduce((sum, i) => sum + Math.hypot(loads[i][0], loads[i][1]) + Math.abs(loads[i][2]) / length, 0);
  const weight = size(dead) || 1, push = size(live);

  // Columns of the programme: what a force on each joint puts on the free blocks, moments divided by the length.
  const vectors = [], columns = [];
  for (let p = 0; p < m; p++) {
    const [nx, ny] = normal[p], t = [(end2[p][0] - end1[p][0]) / joint[p], (end2[p][1] - end1[p][1]) / joint[p]];
    for (const vector of [[1, 0, friction[p]], [1, 0, -friction[p]], [0, 1, friction[p]], [0, 1, -friction[p]]]) {
      const column = new Float64Array(3 * free.length);
      const point = vector[0] ? end1[p] : end2[p], f = [nx + vector[2] * t[0], ny + vector[2] * t[1]];
      for (const [block, sign] of [[b[p], 1], [a[p], -1]]) {
        if (!place.has(block)) continue;
        const k = place.get(block), x = point[0] - centroid[block][0], y = point[1] - centroid[block][1];
        column[k] += sign * f[0];
        column[k + 1] += sign * f[1];
        column[k + 2] += (sign * (x * f[1] - y * f[0])) / length;
      }
      vectors.push(vector);
      columns.push(column);
    }
  }
  const loads = (of, unit) => free.flatMap((i) => [of[i][0] / unit, of[i][1] / unit, of[i][2] / (unit * length)]);
  const forces = (x, unit) => friction.map((_, p) => [0, 1, 2].map((k) => {
    let sum = 0;
    for (let j = 4 * p; j < 4 * p + 4; j++) sum += vectors[j][k] * x[j];
    return unit * sum;
  }));
  const motion = (duals) => centroid.map((_, i) => {
    if (!place.has(i)) return [0, 0, 0];
    const k = place.get(i);
    return [-duals[k], -duals[k + 1], -duals[k + 2] / length];
  });

  // First the dead load alone, then the greatest live load upon it.
  columns.push(loads(live, push || 1));
  const tableau = new Tableau(columns, loads(dead, weight).map((value) => -value), settings.pivots);
  const n = tableau.n, artificial = (j) => (j >= n && j < n + tableau.m ? 1 : 0);
  tableau.minimise(artificial, n - 1);
  if (-tableau.costs[n + tableau.m] > 1e-9) {
    return { finding: 'falls', flow: 'associated', mechanism: motion(tableau.duals(1)), sentence: 'No forces balance the dead load.' };
  }
  const standing = forces(tableau.values(), weight);
  if (!push) return { finding: 'stands', forces: standing, sentence: 'Forces within yield balance the dead load.' };
  const ray = tableau.minimise((j) => (j === n - 1 ? -1 : 0), n);
  if (ray >= 0) {
    const rate = new Float64Array(n);
    rate[ray] = 1;
    tableau.rows.forEach((row, i) => { if (tableau.basis[i] < n) rate[tableau.basis[i]] -= row[ray]; });
    return { finding: 'unbounded', forces: standing, live_forces: forces(rate, push / rate[n - 1]), sentence: 'The joints bear any multiple of the live load.' };
  }
  const x = tableau.values(), multiplier = (x[n - 1] * weight) / push;
  return {
    finding: 'collapses', flow: 'associated', multiplier, forces: forces(x, weight), mechanism: motion(tableau.duals(0)),
    sentence: `No equilibrium within yield above ${multiplier.toPrecision(7)}.`,
  };
}

if (process.argv.includes('--describe')) {
  console.log(JSON.stringify(ABOUT));
} else {
  readline.createInterface({ input: process.stdin }).on('line', (line) => {
    let result;
    try {
      const request = JSON.parse(line);
      result = solve(request.wall, request.settings);
    } catch (error) {
      result = { status: 'not_converged', sentence: String(error.message) };
    }
    console.log(JSON.stringify({ format: 'result/1', ...result }));
  });
}
