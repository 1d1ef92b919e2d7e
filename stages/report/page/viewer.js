"use strict";
(() => {
  const data = JSON.parse(document.getElementById("mesh-data").textContent);
  const canvas = document.getElementById("canvas");
  if (!data || !canvas) return;
  const ask = (id) => document.getElementById(id);
  const status = ask("viewer-status");
  const gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
  if (!gl || !window.DecompressionStream) {
    status.textContent = "This browser is too old to turn the meshes: it needs WebGL 2 and DecompressionStream.";
    return;
  }

  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  // The arrays of an object, as stages/report/packing.py stored them: [offset, count] into its deflated bytes.
  let store = new Uint8Array(0);
  const words = ([at, count]) => Uint16Array.from({ length: count }, (_, k) => store[at + k] | (store[at + count + k] << 8));
  const summed = (values, stride) => {
    for (let k = stride; k < values.length; k++) values[k] += values[k - stride];
    return values;
  };
  const octets = ([at, count]) => summed(store.slice(at, at + count), 1);
  const ids = (where) => summed(words(where), 1);
  const positions = (where) => Float32Array.from(summed(new Int16Array(words(where).buffer), 3), (v) => v / 8190);
  const triangles = (where) => {
    let following = 0;
    return words(where).map((below) => (below === 0 ? following++ : following - below));
  };
  async function unpack(one) {
    const stream = new Blob([bytes(one.store)]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  }
  const colours = bytes(data.colours);

  const vertexShader = `#version 300 es
    in vec3 position; in float value;
    uniform mat3 turn; uniform float zoom; uniform vec2 aspect; uniform float lift; uniform float size;
    out vec3 place; out float shade;
    void main() {
      place = turn * position; shade = value;
      gl_Position = vec4(place.xy * zoom * aspect, -0.5 * place.z - lift, 1.0);
      gl_PointSize = size;
    }`;
  const fragmentShader = `#version 300 es
    precision highp float;
    in vec3 place; in float shade;
    uniform sampler2D table; uniform int mode; uniform vec3 plain;
    out vec4 colour;
    void main() {
      if (mode == 1) { colour = vec4(0.1, 0.15, 0.22, 1.0); return; }
      if (mode == 2) {
        float away = length(gl_PointCoord - 0.5);
        if (away > 0.5) discard;
        colour = away > 0.36 ? vec4(1.0) : vec4(0.85, 0.1, 0.1, 1.0); return;
      }
      vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
      if (normal.z < 0.0) normal = -normal;
      float light = 0.45 + 0.3 * normal.z + 0.35 * max(dot(normal, normalize(vec3(-0.35, 0.55, 0.75))), 0.0);
      vec3 base = shade < 0.0 ? plain : texture(table, vec2(shade * 63.0 / 64.0 + 0.5 / 64.0, 0.5)).rgb;
      colour = vec4(base * light, 1.0);
    }`;

  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertexShader], [gl.FRAGMENT_SHADER, fragmentShader]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.bindAttribLocation(program, 0, "position");
  gl.bindAttribLocation(program, 1, "value");
  gl.linkProgram(program);
  gl.useProgram(program);
  const at = Object.fromEntries(
    ["turn", "zoom", "aspect", "lift", "size", "mode", "plain"].map((name) => [name, gl.getUniformLocation(program, name)]));
  gl.enable(gl.DEPTH_TEST);
  gl.clearColor(1, 1, 1, 1);
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB, colours.length / 3, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, colours);
  for (const [key, value] of [[gl.TEXTURE_MIN_FILTER, gl.LINEAR], [gl.TEXTURE_MAG_FILTER, gl.LINEAR],
    [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]]) {
    gl.texParameteri(gl.TEXTURE_2D, key, value);
  }
  const buffers = { positions: gl.createBuffer(), values: gl.createBuffer(), faces: gl.createBuffer(), edges: gl.createBuffer(), points: gl.createBuffer() };
  const view = { azimuth: 305, elevation: 22, zoom: 1.75 };
  let drawn = { faces: 0, edges: 0, points: 0 };

  const object = () => data.objects[ask("object").value];
  const level = () => {
    const ladder = object().ladders[ask("ladder").value];
    const step = Number(ask("level").value);
    return step > 0 && ladder ? ladder.levels[step - 1] : object().full;
  };

  function fill(select, entries) {
    const wanted = select.options.length ? select.value : "enhanced";
    select.replaceChildren(...entries.map(([value, text]) => new Option(text, value)));
    if (entries.some(([value]) => String(value) === wanted)) select.value = wanted;
  }

  async function chooseObject() {
    const one = object();
    store = await unpack(one);
    const saliency = Object.entries(one.saliency).map(([key, item]) => [key, "saliency: " + item.label]);
    fill(ask("colour"), [...saliency, ["error", "error of this level"], ["", "none"]]);
    fill(ask("points"), [...Object.entries(one.points).map(([key, item]) => [key, item.label]), ["", "none"]]);
    const ladders = Object.entries(one.ladders).map(([key, item]) => [key, item.label]);
    fill(ask("ladder"), ladders.length ? ladders : [["", "not run"]]);
    chooseLadder();
  }

  function chooseLadder() {
    const ladder = object().ladders[ask("ladder").value];
    ask("level").max = ladder ? ladder.levels.length : 0;
    ask("level").disabled = !ladder || !ladder.levels.length;
    upload();
  }

  function values(mesh, count) {
    const out = new Float32Array(count).fill(-1);
    const chosen = ask("colour").value;
    if (chosen === "error") {
      const error = mesh.error ? octets(mesh.error) : new Uint8Array(count);
      return out.map((_, k) => error[k] / 63);
    }
    if (!chosen) return out;
    const saliency = octets(object().saliency[chosen].values);
    const nearest = mesh.nearest ? ids(mesh.nearest) : null;
    return out.map((_, k) => saliency[nearest ? nearest[k] : k] / 63);
  }

  function upload() {
    const mesh = level();
    const place = positions(mesh.positions);
    const faces = triangles(mesh.triangles);
    const edges = new Uint16Array(faces.length * 2);
    for (let k = 0; k < faces.length; k += 3) {
      for (let c = 0; c < 3; c++) {
        edges[2 * (k + c)] = faces[k + c];
        edges[2 * (k + c) + 1] = faces[k + ((c + 1) % 3)];
      }
    }
    const chosen = ask("points").value;
    const marked = chosen ? ids(object().points[chosen].ids) : [];
    const full = positions(object().full.positions);
    const points = Float32Array.from({ length: marked.length * 3 }, (_, k) => full[3 * marked[Math.floor(k / 3)] + (k % 3)]);
    for (const [name, kind, content] of [["positions", gl.ARRAY_BUFFER, place], ["values", gl.ARRAY_BUFFER, values(mesh, place.length / 3)],
      ["points", gl.ARRAY_BUFFER, points], ["faces", gl.ELEMENT_ARRAY_BUFFER, faces], ["edges", gl.ELEMENT_ARRAY_BUFFER, edges]]) {
      gl.bindBuffer(kind, buffers[name]);
      gl.bufferData(kind, content, gl.STATIC_DRAW);
    }
    drawn = { faces: faces.length, edges: edges.length, points: marked.length };
    describe(mesh);
    draw();
  }

  function describe(mesh) {
    const chosen = ask("colour").value;
    const error = chosen === "error";
    const worst = mesh.error_max === undefined ? "the original itself" : `largest error ${mesh.error_max} % of the diagonal`;
    status.textContent = `${object().name}, ${mesh.faces.toLocaleString("en")} faces` + (error ? `, ${worst}` : "");
    ask("bar").parentElement.style.visibility = chosen ? "visible" : "hidden";
    ask("bar-low").textContent = "0";
    ask("bar-high").textContent = error ? `${mesh.error_max || 0} %` : "top 2 %";
    ask("level").setAttribute("aria-valuetext", `${mesh.faces} faces`);
    canvas.setAttribute("aria-label", `Turnable mesh: ${status.textContent}`);
  }

  function turn() {
    const a = view.azimuth * Math.PI / 180, e = view.elevation * Math.PI / 180;
    const [ca, sa, ce, se] = [Math.cos(a), Math.sin(a), Math.cos(e), Math.sin(e)];
    // Columns of the matrix whose rows are right, up, back: the camera of T3.2.6.
    return [-sa, -se * ca, ce * ca, ca, -se * sa, ce * sa, 0, ce, se];
  }

  function attribute(slot, buffer, count) {
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(slot);
    gl.vertexAttribPointer(slot, count, gl.FLOAT, false, 0, 0);
  }

  function draw() {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [w, h] = [canvas.clientWidth * ratio, canvas.clientHeight * ratio].map(Math.round);
    if (canvas.width !== w || canvas.height !== h) { canvas.width = w; canvas.height = h; }
    gl.viewport(0, 0, w, h);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix3fv(at.turn, false, turn());
    gl.uniform1f(at.zoom, view.zoom);
    gl.uniform2f(at.aspect, Math.min(1, h / w), Math.min(1, w / h));
    gl.uniform3f(at.plain, 0.8, 0.8, 0.82);
    attribute(0, buffers.positions, 3);
    attribute(1, buffers.values, 1);
    const passes = [[0, gl.TRIANGLES, buffers.faces, drawn.faces, 0]];
    if (ask("edges").checked) passes.push([1, gl.LINES, buffers.edges, drawn.edges, 0.001]);
    for (const [mode, kind, buffer, count, lift] of passes) {
      gl.uniform1i(at.mode, mode);
      gl.uniform1f(at.lift, lift);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
      gl.drawElements(kind, count, gl.UNSIGNED_SHORT, 0);
    }
    if (drawn.points) {
      attribute(0, buffers.points, 3);
      gl.disableVertexAttribArray(1);
      gl.uniform1i(at.mode, 2);
      gl.uniform1f(at.lift, 0.004);
      gl.uniform1f(at.size, 10 * ratio);
      gl.drawArrays(gl.POINTS, 0, drawn.points);
    }
  }

  function move(azimuth, elevation, zoom = 1) {
    view.azimuth += azimuth;
    view.elevation = Math.max(-90, Math.min(90, view.elevation + elevation));
    view.zoom = Math.max(0.6, Math.min(12, view.zoom * zoom));
    draw();
  }

  function reset() {
    Object.assign(view, { azimuth: 305, elevation: 22, zoom: 1.75 });
    draw();
  }

  const fingers = new Map();
  const spread = () => {
    const [a, b] = [...fingers.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  canvas.addEventListener("pointermove", (event) => {
    const last = fingers.get(event.pointerId);
    if (!last) return;
    const before = fingers.size === 2 ? spread() : 0;
    const [dx, dy] = [event.clientX - last.x, event.clientY - last.y];
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (fingers.size === 2) move(0, 0, spread() / before);
    else move(-0.4 * dx, 0.4 * dy);
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => fingers.delete(event.pointerId));
  canvas.addEventListener("wheel", (event) => {
    if (document.activeElement !== canvas) return;  // the page scrolls until the picture is chosen
    event.preventDefault();
    move(0, 0, Math.exp(-0.001 * event.deltaY));
  }, { passive: false });
  const keys = { ArrowLeft: [8, 0], ArrowRight: [-8, 0], ArrowUp: [0, 8], ArrowDown: [0, -8], "+": [0, 0, 1.15], "=": [0, 0, 1.15], "-": [0, 0, 1 / 1.15] };
  canvas.addEventListener("keydown", (event) => {
    if (event.key === "0") reset();
    else if (keys[event.key]) move(...keys[event.key]);
    else return;
    event.preventDefault();
  });

  const bar = ask("bar").getContext("2d");
  for (let k = 0; k < 64; k++) {
    bar.fillStyle = `rgb(${colours[3 * k]}, ${colours[3 * k + 1]}, ${colours[3 * k + 2]})`;
    bar.fillRect(k, 0, 1, 1);
  }
  if (data.left_out.length) ask("left-out").textContent = `Left out, to keep the page small: ${data.left_out.join(", ")}.`;
  fill(ask("object"), data.objects.map((one, k) => [k, one.name]));
  ask("object").addEventListener("change", () => { ask("level").value = 0; chooseObject(); });
  ask("ladder").addEventListener("change", chooseLadder);
  for (const id of ["colour", "points", "level"]) ask(id).addEventListener("input", upload);
  ask("edges").addEventListener("input", draw);
  ask("reset").addEventListener("click", reset);
  ask("controls").addEventListener("submit", (event) => event.preventDefault());
  new ResizeObserver(draw).observe(canvas);
  chooseObject();
})();
