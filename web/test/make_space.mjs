// The sample with a model in three dimensions, in closed form: a rigid block that rocks on a box of soil, and beside it
// a column on a rigid footing.
//
// The block turns by a small angle θ about a fixed direction of its base while its weight W stays carried:
//   opening of point i:  g_i = v + θ d_i            (d_i: distance of the point from the axis through the centre)
//   pressure of point i: p_i = k max(−g_i, 0)       with v from  Σ p_i A_i = W
//   displacement:        u = v e_z + r × (X − C),   r = θ (cos α, sin α, 0), so that u_z = v + θ d on the base
const SOIL = { x: [-9, 12], y: [-8, 8], z: [-5, 0], cells: [14, 8, 4] };
const BLOCK = { x: [-5, 1], y: [-3, 3], z: [0, 12], cells: [6, 6, 6] };
const DIRECTION = Math.PI / 6; // of the axis of rotation in plan
const SUBGRADE = 4e7; // Pa/m
const WEIGHT = 9e6; // N
const FOOTING = { x: 7.5, y: 1, half: 1.5, points: 6, height: 7, weight: 4e5 };
const FRAMES = 33;
const END = 2.4; // s

/** Rigid rotation of the block at time t. */
const angle = (t) => 0.006 * Math.sin((2 * Math.PI * t) / 0.8) * Math.sin((Math.PI * t) / END);

const round = (v, unit) => Number((Math.round(v / unit) * unit).toPrecision(12)) || 0;

/** Nodes on the surface of a structured box, its triangles (outwards) and edges. */
function box_surface({ x, y, z, cells }, nodes, name) {
  const [nx, ny, nz] = cells;
  const found = new Map();
  const node = (i, j, k) => {
    const key = `${i} ${j} ${k}`;
    if (!found.has(key)) {
      found.set(key, nodes.length / 3);
      const along = ([a, b], n, m) => a + ((b - a) * m) / n;
      nodes.push(along(x, nx, i), along(y, ny, j), along(z, nz, k));
    }
    return found.get(key);
  };
  const triangles = [];
  const edges = new Set();
  const quad = (...corners) => {
    const [a, b, c, d] = corners.map((p) => node(...p));
    triangles.push(a, b, c, a, c, d);
    for (const [p, q] of [[a, b], [b, c], [c, d], [d, a]]) edges.add(p < q ? `${p} ${q}` : `${q} ${p}`);
  };
  for (let i = 0; i < nx; i++) for (let j = 0; j < ny; j++) {
    quad([i, j, 0], [i, j + 1, 0], [i + 1, j + 1, 0], [i + 1, j, 0]);
    quad([i, j, nz], [i + 1, j, nz], [i + 1, j + 1, nz], [i, j + 1, nz]);
  }
  for (let i = 0; i < nx; i++) for (let k = 0; k < nz; k++) {
    quad([i, 0, k], [i + 1, 0, k], [i + 1, 0, k + 1], [i, 0, k + 1]);
    quad([i, ny, k], [i, ny, k + 1], [i + 1, ny, k + 1], [i + 1, ny, k]);
  }
  for (let j = 0; j < ny; j++) for (let k = 0; k < nz; k++) {
    quad([0, j, k], [0, j, k + 1], [0, j + 1, k + 1], [0, j + 1, k]);
    quad([nx, j, k], [nx, j + 1, k], [nx, j + 1, k + 1], [nx, j, k + 1]);
  }
  return { part: { name, triangles, edges: [...edges].flatMap((e) => e.split(" ").map(Number)) }, node };
}

/** The base of the block: one point per node of its lower side, areas of the nodes. */
function raft_face(base) {
  const [nx, ny] = BLOCK.cells;
  const [dx, dy] = [(BLOCK.x[1] - BLOCK.x[0]) / nx, (BLOCK.y[1] - BLOCK.y[0]) / ny];
  const face = { name: "raft", points: [], plan: [], axes: ["x", "y"], normal: [0, 0, 1], area: [], triangles: [], node: [] };
  const end = (i, n) => (i === 0 || i === n ? 0.5 : 1);
  for (let j = 0; j <= ny; j++) for (let i = 0; i <= nx; i++) {
    const [x, y] = [BLOCK.x[0] + i * dx, BLOCK.y[0] + j * dy];
    face.points.push(x, y, 0);
    face.plan.push(x, y);
    face.area.push(dx * dy * end(i, nx) * end(j, ny));
    face.node.push(base(i, j, 0));
    const a = j * (nx + 1) + i;
    if (i < nx && j < ny) face.triangles.push(a, a + 1, a + nx + 2, a, a + nx + 2, a + nx + 1);
  }
  return face;
}

/** The footing: points in the middle of equal squares, carried by a rigid body; no triangles. */
function footing_face() {
  const { x, y, half, points: n } = FOOTING;
  const side = (2 * half) / n;
  const face = { name: "footing", points: [], plan: [], axes: ["x", "y"], normal: [0, 0, 1], area: [], triangles: [], body: 0 };
  for (let j = 0; j < n; j++) for (let i = 0; i < n; i++) {
    const place = [x - half + (i + 0.5) * side, y - half + (j + 0.5) * side];
    face.points.push(...place, 0);
    face.plan.push(...place);
    face.area.push(side * side);
  }
  return face;
}

/** Rise v of a rigid base turned by θ: bisection on Σ k max(−g, 0) A = W. `far` holds the distances of the points from the axis. */
export function rise(theta, far, area, weight) {
  const carried = (v) => far.reduce((sum, d, i) => sum + SUBGRADE * Math.max(0, -(v + theta * d)) * area[i], 0);
  let [low, high] = [-1, 1];
  for (let i = 0; i < 80; i++) {
    const v = (low + high) / 2;
    if (carried(v) > weight) low = v;
    else high = v;
  }
  return (low + high) / 2;
}

/** Openings of a face turned about an axis through (x, y) with direction (c, s): d = (X − C) × axis, upwards. */
function turned(face, [cx, cy], [c, s], theta, weight) {
  const far = face.area.map((_a, i) => c * (face.points[3 * i + 1] - cy) - s * (face.points[3 * i] - cx));
  const v = rise(theta, far, face.area, weight);
  return { v, openings: far.map((d) => v + theta * d) };
}

function animation(run, space, grow) {
  const [raft, footing] = space.interfaces;
  const centre = [(BLOCK.x[0] + BLOCK.x[1]) / 2, (BLOCK.y[0] + BLOCK.y[1]) / 2];
  const way = [Math.cos(DIRECTION), Math.sin(DIRECTION)];
  const out = { run, time: [], displacement: [], rotation: { plinth: [] }, openings: { raft: [], footing: [] }, pressures: { raft: [], footing: [] }, slips: { raft: [] } };
  for (let f = 0; f < FRAMES; f++) {
    const t = (END * f) / (FRAMES - 1);
    const theta = grow * angle(t);
    const small = -1.6 * grow * angle(t + 0.13);
    const block = turned(raft, centre, way, theta, WEIGHT);
    const plinth = turned(footing, [FOOTING.x, FOOTING.y], [0, 1], small, FOOTING.weight);
    const u = [];
    for (let n = 0; 3 * n < space.nodes.length; n++) {
      const [x, y, z] = space.nodes.slice(3 * n, 3 * n + 3);
      if (n >= space.first.stick) u.push(small * z, 0, plinth.v);
      else if (n >= space.first.block) {
        // r × d with r = θ (c, s, 0): (s dz, −c dz, c dy − s dx)
        const [dx, dy] = [x - centre[0], y - centre[1]];
        u.push(theta * way[1] * z, -theta * way[0] * z, block.v + theta * (way[0] * dy - way[1] * dx));
      } else u.push(0, 0, 0);
    }
    const press = (openings) => openings.map((g) => round(SUBGRADE * Math.max(0, -g), 100));
    out.time.push(round(t, 1e-3));
    out.displacement.push(u.map((v) => round(v, 1e-5)));
    out.rotation.plinth.push([0, round(small, 1e-7), 0]);
    out.openings.raft.push(block.openings.map((g) => round(g, 1e-7)));
    out.openings.footing.push(plinth.openings.map((g) => round(g, 1e-7)));
    out.pressures.raft.push(press(block.openings));
    out.pressures.footing.push(press(plinth.openings));
    out.slips.raft.push(raft.area.map((_a, i) => round(Math.abs(theta) * 0.05 * Math.hypot(raft.points[3 * i] - centre[0], raft.points[3 * i + 1] - centre[1]), 1e-7)));
  }
  return out;
}

function space_model() {
  const nodes = [];
  const soil = box_surface(SOIL, nodes, "soil");
  const block_first = nodes.length / 3;
  const block = box_surface(BLOCK, nodes, "block");
  const stick_first = nodes.length / 3;
  const { x, y, half, height } = FOOTING;
  const levels = 5;
  for (let k = 0; k < levels; k++) nodes.push(x, y, 0.5 + ((height - 0.5) * k) / (levels - 1));
  const outline = [[-1, -1], [1, -1], [1, 1], [-1, 1]].flatMap(([a, b]) => [x + a * half, y + b * half, 0]);
  const stick = Array.from({ length: levels }, (_, k) => stick_first + k);
  const supports = [];
  for (let n = 0; n < block_first; n++) if (nodes[3 * n + 2] === SOIL.z[0]) supports.push({ node: n, dofs: ["ux", "uy", "uz"] });
  // The sides x = constant absorb.
  const sides = [];
  for (let t = 0; t < soil.part.triangles.length; t += 3) {
    const corners = soil.part.triangles.slice(t, t + 3);
    if (SOIL.x.some((x) => corners.every((n) => nodes[3 * n] === x))) sides.push(...corners);
  }
  const space = {
    nodes: nodes.map((v) => round(v, 1e-6)),
    parts: [soil.part, block.part],
    lines: [{ name: "column", nodes: stick }],
    bodies: [{ name: "plinth", node: stick_first, corners: outline }],
    masses: [{ node: stick[levels - 1], mass: 30e3 }],
    supports,
    borders: [{ name: "sides", kind: "absorbing", triangles: sides }],
    interfaces: [raft_face(block.node), footing_face()],
    loads: [{ node: stick[levels - 1], force: [1, 0, 0], label: "F(t), 60 kN" }],
  };
  // What only the sample needs to know stays out of the document.
  Object.defineProperty(space, "first", { value: { block: block_first, stick: stick_first } });
  return space;
}

/** A whole document; with `faces` 1 only the raft is there. */
export function space_document(base) {
  const space = space_model();
  const [first] = base.charts;
  return {
    ...base,
    summary: { ...base.summary, title: "Block rocking on soil" }, subtitle: "Sample of a model in three dimensions", tables: [], sections: base.sections.slice(0, 2), charts: [first], model: null, animations: [],
    space, spaceAnimations: [animation("SDM, path average", space, 1), animation("Tensionless springs", space, 0.7)],
  };
}
