// The turnable mesh: the camera, drawing by WebGL, and which vertex lies at a place of the picture.
// Camera as in T3.2.6: orthographic, azimuth 0 stands on +x, +z up. Places are CSS pixels from the upper left corner.

export const START = { azimuth: 305, elevation: 22, zoom: 1, x: 0, y: 0 };
const FILL = 0.92; // of the picture's shorter side that the bounding sphere takes at zoom 1
const ZOOMS = [0.5, 40];
const CLOSE = 0.002; // units; a surface nearer than this before a vertex does not hide it

const VERTEX = `#version 300 es
  in vec3 position;
  uniform mat3 turn; uniform vec2 scale; uniform vec2 centre;
  out vec3 place;
  void main() {
    place = turn * position;
    gl_Position = vec4((place.xy - centre) * scale, -0.5 * place.z, 1.0);
  }`;
const FRAGMENT = `#version 300 es
  precision highp float;
  in vec3 place;
  out vec4 colour;
  void main() {
    vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
    if (normal.z < 0.0) normal = -normal;
    float light = 0.42 + 0.28 * normal.z + 0.38 * max(dot(normal, normalize(vec3(-0.35, 0.55, 0.75))), 0.0);
    colour = vec4(vec3(0.80, 0.80, 0.82) * light, 1.0);
  }`;

// Whether a graphics card draws; on a processor smooth edges would cost two thirds of the pictures a second.
function drawnByCard() {
  const gl = document.createElement("canvas").getContext("webgl2");
  const more = gl && gl.getExtension("WEBGL_debug_renderer_info");
  return Boolean(more) && !/swiftshader|llvmpipe|software|basic render/i.test(gl.getParameter(more.UNMASKED_RENDERER_WEBGL));
}

export class View {
  // drawn: called after each picture. Throws where the browser has no WebGL 2.
  constructor(canvas, positions, triangles, drawn) {
    Object.assign(this, { canvas, positions, triangles, drawn, camera: { ...START }, waiting: false });
    this.turned = new Float32Array(positions.length); // right, up, towards the viewer
    this.prepare();
    canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    canvas.addEventListener("webglcontextrestored", () => { this.prepare(); this.draw(); });
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  prepare() {
    const gl = this.canvas.getContext("webgl2", { antialias: drawnByCard() });
    if (!gl) throw new Error("This browser cannot turn the mesh: it needs WebGL 2.");
    const program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.bindAttribLocation(program, 0, "position");
    gl.linkProgram(program);
    gl.useProgram(program);
    for (const [kind, content] of [[gl.ARRAY_BUFFER, this.positions], [gl.ELEMENT_ARRAY_BUFFER, this.triangles]]) {
      gl.bindBuffer(kind, gl.createBuffer());
      gl.bufferData(kind, content, gl.STATIC_DRAW);
    }
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(1, 1, 1, 1);
    this.gl = gl;
    this.at = Object.fromEntries(["turn", "scale", "centre"].map((name) => [name, gl.getUniformLocation(program, name)]));
  }

  // Rows right, up, back: the camera's axes in the world.
  axes() {
    const [a, e] = [this.camera.azimuth, this.camera.elevation].map((degrees) => (degrees * Math.PI) / 180);
    const [ca, sa, ce, se] = [Math.cos(a), Math.sin(a), Math.cos(e), Math.sin(e)];
    return [[-sa, ca, 0], [-se * ca, -se * sa, ce], [ce * ca, ce * sa, se]];
  }

  get pixels() { // a unit of the mesh takes
    return FILL * Math.min(this.canvas.clientWidth, this.canvas.clientHeight) * this.camera.zoom;
  }

  draw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => { this.waiting = false; this.paint(); });
  }

  // Draws a pending frame now, so that a click is evaluated on the current view.
  paintPending() {
    if (this.waiting) this.paint();
  }

  paint() {
    const { gl, canvas, camera, positions, turned } = this;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [w, h] = [canvas.clientWidth, canvas.clientHeight];
    if (!w || !h) return;
    const size = [w * ratio, h * ratio].map(Math.round);
    if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
    gl.viewport(0, 0, ...size);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const [r, u, b] = this.axes();
    gl.uniformMatrix3fv(this.at.turn, false, [0, 1, 2].flatMap((k) => [r[k], u[k], b[k]]));
    gl.uniform2f(this.at.scale, (2 * this.pixels) / w, (2 * this.pixels) / h);
    gl.uniform2f(this.at.centre, camera.x, camera.y);
    gl.drawElements(gl.TRIANGLES, this.triangles.length, gl.UNSIGNED_INT, 0);
    for (let k = 0; k < positions.length; k += 3) {
      const [x, y, z] = [positions[k], positions[k + 1], positions[k + 2]];
      turned[k] = r[0] * x + r[1] * y + r[2] * z;
      turned[k + 1] = u[0] * x + u[1] * y + u[2] * z;
      turned[k + 2] = b[0] * x + b[1] * y + b[2] * z;
    }
    this.drawn();
  }

  // From a place of the picture to units right of and above the mesh's centre.
  offset(left, top) {
    const { canvas, camera, pixels } = this;
    return [camera.x + (left - canvas.clientWidth / 2) / pixels, camera.y - (top - canvas.clientHeight / 2) / pixels];
  }

  // The front-most surface at each offset [x, y]: its first corner's place in `triangles` (-1: none) and its depth.
  surfaces(offsets) {
    const { triangles, turned } = this;
    const found = offsets.map(() => ({ face: -1, depth: -Infinity }));
    const [xs, ys] = [0, 1].map((axis) => Float64Array.from(offsets, (offset) => offset[axis]));
    for (let face = 0; face < triangles.length; face += 3) {
      const a = 3 * triangles[face], b = 3 * triangles[face + 1], c = 3 * triangles[face + 2];
      const ax = turned[a], ay = turned[a + 1], bx = turned[b], by = turned[b + 1], cx = turned[c], cy = turned[c + 1];
      const left = Math.min(ax, bx, cx), right = Math.max(ax, bx, cx);
      const low = Math.min(ay, by, cy), high = Math.max(ay, by, cy);
      for (let k = 0; k < xs.length; k++) {
        const x = xs[k], y = ys[k];
        if (x < left || x > right || y < low || y > high) continue;
        const area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay); // 0 edge-on: wb is then no number
        const wb = ((x - ax) * (cy - ay) - (cx - ax) * (y - ay)) / area;
        const wc = ((bx - ax) * (y - ay) - (x - ax) * (by - ay)) / area;
        if (!(wb >= 0 && wc >= 0 && wb + wc <= 1)) continue;
        const depth = turned[a + 2] + wb * (turned[b + 2] - turned[a + 2]) + wc * (turned[c + 2] - turned[a + 2]);
        if (depth > found[k].depth) found[k] = { face, depth };
      }
    }
    return found;
  }

  // The vertex nearest to where the ray through a place meets the mesh, among the corners of the face hit; -1 off it.
  pick(left, top) {
    const [x, y] = this.offset(left, top);
    const { face, depth } = this.surfaces([[x, y]])[0];
    if (face < 0) return -1;
    const away = (v) => Math.hypot(this.turned[3 * v] - x, this.turned[3 * v + 1] - y, this.turned[3 * v + 2] - depth);
    return [...this.triangles.slice(face, face + 3)].reduce((best, v) => (away(v) < away(best) ? v : best));
  }

  // Where vertices are in the picture: list of { left, top, hidden }.
  places(vertices) {
    const { canvas, camera, pixels, turned } = this;
    const offsets = vertices.map((v) => [turned[3 * v], turned[3 * v + 1]]);
    const before = this.surfaces(offsets);
    return vertices.map((v, k) => ({
      left: canvas.clientWidth / 2 + (offsets[k][0] - camera.x) * pixels,
      top: canvas.clientHeight / 2 - (offsets[k][1] - camera.y) * pixels,
      hidden: before[k].depth > turned[3 * v + 2] + CLOSE,
    }));
  }

  turn(azimuth, elevation) {
    this.camera.azimuth = (this.camera.azimuth + azimuth) % 360;
    this.camera.elevation = Math.max(-90, Math.min(90, this.camera.elevation + elevation));
    this.draw();
  }

  shift(right, down) { // the mesh, by pixels
    this.camera.x = Math.max(-0.5, Math.min(0.5, this.camera.x - right / this.pixels));
    this.camera.y = Math.max(-0.5, Math.min(0.5, this.camera.y + down / this.pixels));
    this.draw();
  }

  // The surface under the place (left, top), by default the middle, stays where it is.
  zoom(factor, left = this.canvas.clientWidth / 2, top = this.canvas.clientHeight / 2) {
    const [x, y] = this.offset(left, top);
    this.camera.zoom = Math.max(ZOOMS[0], Math.min(ZOOMS[1], this.camera.zoom * factor));
    const [now, then] = this.offset(left, top);
    this.shift((now - x) * this.pixels, (y - then) * this.pixels);
  }

  // Looks straight at a vertex, along the area-weighted normal of the faces around it.
  face(vertex) {
    const { positions: p, triangles } = this;
    const normal = [0, 0, 0];
    for (let k = 0; k < triangles.length; k += 3) {
      const corners = [...triangles.slice(k, k + 3)];
      if (!corners.includes(vertex)) continue;
      const [a, b, c] = corners.map((v) => [p[3 * v], p[3 * v + 1], p[3 * v + 2]]);
      const [s, t] = [b, c].map((corner) => corner.map((value, axis) => value - a[axis]));
      for (let axis = 0; axis < 3; axis++) {
        const [i, j] = [(axis + 1) % 3, (axis + 2) % 3];
        normal[axis] += s[i] * t[j] - s[j] * t[i];
      }
    }
    if (!Math.hypot(...normal)) return;
    const degrees = 180 / Math.PI;
    this.camera.azimuth = Math.atan2(normal[1], normal[0]) * degrees;
    this.camera.elevation = Math.atan2(normal[2], Math.hypot(normal[0], normal[1])) * degrees;
    const [right, up] = this.axes().map((axis) => axis[0] * p[3 * vertex] + axis[1] * p[3 * vertex + 1] + axis[2] * p[3 * vertex + 2]);
    if (this.camera.zoom > 1) [this.camera.x, this.camera.y] = [right, up];
    this.draw();
  }

  reset() {
    Object.assign(this.camera, START);
    this.draw();
  }
}
