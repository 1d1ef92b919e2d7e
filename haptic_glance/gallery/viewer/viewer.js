"use strict";
(() => {
  const data = JSON.parse(document.getElementById("mesh-data").textContent);
  const canvas = document.getElementById("canvas");
  if (!data || !canvas) return;
  const ask = (id) => document.getElementById(id);
  const gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
  if (!gl || !window.DecompressionStream) {
    ask("viewer-left").textContent = "This browser is too old to turn the meshes: it needs WebGL 2 and DecompressionStream.";
    return;
  }

  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  // The arrays of an object, as haptic_glance/base/packing.py stored them: [offset, count] into its deflated bytes.
  let store = new Uint8Array(0);
  const words = ([at, count]) => Uint16Array.from({ length: count }, (_, k) => store[at + k] | (store[at + count + k] << 8));
  const summed = (values, stride) => {
    for (let k = stride; k < values.length; k++) values[k] += values[k - stride];
    return values;
  };
  const octets = ([at, count], stride = 1) => summed(store.slice(at, at + count), stride);
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
    in vec3 position; in float value; in vec3 tint;
    uniform mat3 turn; uniform float zoom; uniform vec2 aspect; uniform float lift; uniform float size;
    out vec3 place; out float shade; out vec3 own;
    void main() {
      place = turn * position; shade = value; own = tint;
      gl_Position = vec4(place.xy * zoom * aspect, -0.5 * place.z - lift, 1.0);
      gl_PointSize = size;
    }`;
  const fragmentShader = `#version 300 es
    precision highp float;
    in vec3 place; in float shade; in vec3 own;
    uniform sampler2D table; uniform int mode; uniform float scale;
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
      vec3 base = shade < -0.5 ? own : texture(table, vec2(shade * 63.0 / 64.0 + 0.5 / 64.0, scale)).rgb;
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
  gl.bindAttribLocation(program, 2, "tint");
  gl.linkProgram(program);
  gl.useProgram(program);
  const at = Object.fromEntries(
    ["turn", "zoom", "aspect", "lift", "size", "mode", "scale"].map((name) => [name, gl.getUniformLocation(program, name)]));
  gl.enable(gl.DEPTH_TEST);
  gl.clearColor(1, 1, 1, 1);
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB, 64, 2, 0, gl.RGB, gl.UNSIGNED_BYTE, colours);
  for (const [key, value] of [[gl.TEXTURE_MIN_FILTER, gl.LINEAR], [gl.TEXTURE_MAG_FILTER, gl.LINEAR],
    [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]]) {
    gl.texParameteri(gl.TEXTURE_2D, key, value);
  }
  const panes = [0, 1].map(() => ({
    positions: gl.createBuffer(), values: gl.createBuffer(), faces: gl.createBuffer(), edges: gl.createBuffer(), count: 0 }));
  const tints = gl.createBuffer();  // colours of the mesh's own, of an object without levels
  const marks = { buffer: gl.createBuffer(), count: 0 };
  const view = { azimuth: 305, elevation: 22, zoom: 1.75 };

  const object = () => data.objects[ask("object").value];
  const alone = () => !Object.keys(object().ladders).length;  // an object without levels has the whole picture
  // The simplified mesh that the slider is at; the original itself at its left end.
  const level = () => {
    const ladder = object().ladders[ask("ladder").value];
    const step = Number(ask("level").value);
    return step > 0 && ladder ? ladder.levels[step - 1] : object().full;
  };

  function fill(select, entries) {
    const wanted = select.options.length ? select.value : select.dataset.first;
    select.replaceChildren(...entries.map(([value, text]) => new Option(text, value)));
    if (entries.some(([value]) => String(value) === wanted)) select.value = wanted;
  }

  async function chooseObject() {
    const one = object();
    store = await unpack(one);
    const saliency = Object.entries(one.saliency).map(([key, item]) => [key, item.label]);
    const errors = Object.keys(one.ladders).length ? [["error", "error (distance)"]] : [];
    const own = one.tints ? [["own", "its own colours"]] : [];
    fill(ask("colour"), [...errors, ...saliency, ...own, ["", "none"]]);
    fill(ask("points"), [...Object.entries(one.points).map(([key, item]) => [key, item.label]), ["", "none"]]);
    const ladders = Object.entries(one.ladders).map(([key, item]) => [key, item.label]);
    fill(ask("ladder"), ladders);
    for (const id of ["ladder", "level"]) ask(id).closest("label").hidden = alone();
    ask("points").closest("label").hidden = !Object.keys(one.points).length;
    chooseLadder();
  }

  function chooseLadder() {
    const ladder = object().ladders[ask("ladder").value];
    const steps = ladder ? ladder.levels.length : 0;
    const wanted = ask("level").dataset.touched ? ask("level").value : Math.ceil(steps / 2);
    ask("level").max = steps;
    ask("level").value = Math.min(wanted, steps);
    ask("level").disabled = !steps;
    upload();
  }

  // For each vertex of one mesh the nearest of the other, both ways.
  function pairs(full, small) {
    const [n, m] = [full.length / 3, small.length / 3];
    const toSmall = new Uint16Array(n), toFull = new Uint16Array(m), least = new Float32Array(m).fill(Infinity);
    for (let i = 0; i < n; i++) {
      const [x, y, z] = [full[3 * i], full[3 * i + 1], full[3 * i + 2]];
      let best = Infinity;
      for (let k = 0; k < m; k++) {
        const [dx, dy, dz] = [small[3 * k] - x, small[3 * k + 1] - y, small[3 * k + 2] - z];
        const away = dx * dx + dy * dy + dz * dz;
        if (away < best) { best = away; toSmall[i] = k; }
        if (away < least[k]) { least[k] = away; toFull[k] = i; }
      }
    }
    return { toSmall, toFull };
  }

  // Shades of the original's vertices and of the simplified ones; an error is known at the original's vertices, and a
  // simplified vertex takes the mean of those that are nearest to it.
  function shades(mesh, full, small) {
    const chosen = ask("colour").value;
    if (!chosen || chosen === "own") return [new Float32Array(full.length / 3).fill(-1), new Float32Array(small.length / 3).fill(-1)];
    const where = chosen === "error" ? mesh.error : object().saliency[chosen].values;
    const left = where ? Float32Array.from(octets(where), (v) => v / 63) : new Float32Array(full.length / 3);
    if (mesh === object().full) return [left, left];
    mesh.pairs ??= pairs(full, small);
    const right = Float32Array.from(mesh.pairs.toFull, (k) => left[k]);
    if (chosen !== "error") return [left, right];
    const sum = new Float32Array(right.length), count = new Uint16Array(right.length);
    mesh.pairs.toSmall.forEach((k, i) => { sum[k] += left[i]; count[k] += 1; });
    return [left, right.map((value, k) => (count[k] ? sum[k] / count[k] : value))];
  }

  function send(pane, mesh, place, values) {
    const faces = triangles(mesh.triangles);
    const edges = new Uint16Array(faces.length * 2);
    for (let k = 0; k < faces.length; k += 3) {
      for (let c = 0; c < 3; c++) {
        edges[2 * (k + c)] = faces[k + c];
        edges[2 * (k + c) + 1] = faces[k + ((c + 1) % 3)];
      }
    }
    for (const [buffer, kind, content] of [[pane.positions, gl.ARRAY_BUFFER, place], [pane.values, gl.ARRAY_BUFFER, values],
      [pane.faces, gl.ELEMENT_ARRAY_BUFFER, faces], [pane.edges, gl.ELEMENT_ARRAY_BUFFER, edges]]) {
      gl.bindBuffer(kind, buffer);
      gl.bufferData(kind, content, gl.STATIC_DRAW);
    }
    pane.count = faces.length;
  }

  function upload() {
    const mesh = level();
    const full = positions(object().full.positions);
    const small = mesh === object().full ? full : positions(mesh.positions);
    const [left, right] = shades(mesh, full, small);
    send(panes[0], object().full, full, left);
    send(panes[1], mesh, small, right);
    if (object().tints) {
      gl.bindBuffer(gl.ARRAY_BUFFER, tints);
      gl.bufferData(gl.ARRAY_BUFFER, octets(object().tints, 3), gl.STATIC_DRAW);
    }
    const chosen = ask("points").value;
    const marked = chosen ? ids(object().points[chosen].ids) : [];
    gl.bindBuffer(gl.ARRAY_BUFFER, marks.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, Float32Array.from({ length: marked.length * 3 }, (_, k) => full[3 * marked[Math.floor(k / 3)] + (k % 3)]), gl.STATIC_DRAW);
    marks.count = marked.length;
    describe(mesh);
    draw();
  }

  function describe(mesh) {
    const one = object();
    const faces = (item) => `${item.faces.toLocaleString("en")} faces`;
    const original = mesh === one.full;
    const share = `${(100 * mesh.faces / one.faces).toFixed(mesh.faces < one.faces / 20 ? 1 : 0)} %`;
    const drawn = (item, shown) => (shown < item.faces ? ` (drawn with ${shown.toLocaleString("en")})` : "");
    ask("viewer-left").textContent = `${one.name}${alone() ? "" : ", original"}: ${faces(one)}${drawn(one, one.full.faces)}`;
    ask("viewer-right").textContent = alone() ? "" : original ? "the original itself: move the slider" :
      `simplified: ${faces(mesh)} (${share})${drawn(mesh, mesh.drawn)}; distance mean ${mesh.error_mean} %, largest ${mesh.error_max} % of the diagonal`;
    ask("level-name").textContent = original ? "the original" : faces(mesh);
    ask("level").setAttribute("aria-valuetext", faces(mesh));
    canvas.setAttribute("aria-label", ["Turnable meshes: " + ask("viewer-left").textContent, ask("viewer-right").textContent].filter(Boolean).join("; "));
    const chosen = ask("colour").value;
    const error = chosen === "error";
    ask("legend").style.visibility = error || one.saliency[chosen] ? "visible" : "hidden";
    const top = one.error_top;
    const tick = (value) => value.toPrecision(2) + " %";
    ask("bar-low").textContent = error ? "0" : "low";
    ask("bar-middle").textContent = error ? tick(top / 4) : "";
    ask("bar-high").textContent = error ? "≥ " + tick(top) : "top 2 %";
    ask("bar-name").textContent = error ? "of the diagonal, the same at all levels" : one.saliency[chosen]?.label ?? "";
    const bar = ask("bar").getContext("2d");
    for (let k = 0; k < 64; k++) {
      const at = 3 * (k + (error ? 64 : 0));
      bar.fillStyle = `rgb(${colours[at]}, ${colours[at + 1]}, ${colours[at + 2]})`;
      bar.fillRect(k, 0, 1, 1);
    }
  }

  function turn() {
    const a = view.azimuth * Math.PI / 180, e = view.elevation * Math.PI / 180;
    const [ca, sa, ce, se] = [Math.cos(a), Math.sin(a), Math.cos(e), Math.sin(e)];
    // Columns of the matrix whose rows are right, up, back: the camera of T3.2.6.
    return [-sa, -se * ca, ce * ca, ca, -se * sa, ce * sa, 0, ce, se];
  }

  function attribute(slot, buffer, count, kind = gl.FLOAT) {
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(slot);
    gl.vertexAttribPointer(slot, count, kind, kind === gl.UNSIGNED_BYTE, 0, 0);
  }

  function draw() {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [w, h] = [canvas.clientWidth * ratio, canvas.clientHeight * ratio].map(Math.round);
    if (canvas.width !== w || canvas.height !== h) { canvas.width = w; canvas.height = h; }
    const stacked = !alone() && h > 1.1 * w;
    const head = Math.round(40 * ratio);  // two lines of caption above each mesh
    ask("stage").classList.toggle("stacked", stacked);
    gl.disable(gl.SCISSOR_TEST);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.SCISSOR_TEST);
    const [pw, ph] = alone() ? [w, h] : stacked ? [w, Math.floor(h / 2)] : [Math.floor(w / 2), h];
    if (ph <= head) return;  // the page has no layout yet
    (alone() ? panes.slice(0, 1) : panes).forEach((pane, k) => {
      const corner = stacked ? [0, k ? 0 : h - ph] : [k ? w - pw : 0, 0];
      gl.viewport(...corner, pw, ph - head);
      gl.scissor(...corner, pw, ph - head);
      drawPane(pane, pw, ph - head, ratio);
    });
  }

  function drawPane(pane, w, h, ratio) {
    gl.uniformMatrix3fv(at.turn, false, turn());
    gl.uniform1f(at.zoom, view.zoom);
    gl.uniform2f(at.aspect, Math.min(1, h / w), Math.min(1, w / h));
    gl.uniform1f(at.scale, ask("colour").value === "error" ? 0.75 : 0.25);
    attribute(0, pane.positions, 3);
    attribute(1, pane.values, 1);
    gl.disableVertexAttribArray(2);
    gl.vertexAttrib3f(2, 0.8, 0.8, 0.82);
    if (ask("colour").value === "own") attribute(2, tints, 3, gl.UNSIGNED_BYTE);
    const passes = [[0, gl.TRIANGLES, pane.faces, pane.count, 0]];
    if (ask("edges").checked) passes.push([1, gl.LINES, pane.edges, 2 * pane.count, 0.001]);
    for (const [mode, kind, buffer, count, lift] of passes) {
      gl.uniform1i(at.mode, mode);
      gl.uniform1f(at.lift, lift);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
      gl.drawElements(kind, count, gl.UNSIGNED_SHORT, 0);
    }
    if (marks.count) {
      attribute(0, marks.buffer, 3);
      gl.disableVertexAttribArray(1);
      gl.uniform1i(at.mode, 2);
      gl.uniform1f(at.lift, 0.004);
      gl.uniform1f(at.size, 8 * ratio);
      gl.drawArrays(gl.POINTS, 0, marks.count);
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

  if (data.left_out.length) ask("left-out").textContent = `Left out, to keep the page small: ${data.left_out.join(", ")}.`;
  fill(ask("object"), data.objects.map((one, k) => [k, one.name]));
  ask("object").addEventListener("change", chooseObject);
  ask("ladder").addEventListener("change", chooseLadder);
  ask("level").addEventListener("input", () => { ask("level").dataset.touched = "yes"; });
  for (const id of ["colour", "points", "level"]) ask(id).addEventListener("input", upload);
  ask("edges").addEventListener("input", draw);
  ask("reset").addEventListener("click", reset);
  ask("controls").addEventListener("submit", (event) => event.preventDefault());
  new ResizeObserver(draw).observe(canvas);
  chooseObject();
})();
