// The style, the bar and the script of viewers (view_page.h).
#include "tools/vdb_synth/view_page.h"

namespace vdbsynth::cli {

const char* const kViewerStyle = R"(
figure.viewer canvas { display: block; background: linear-gradient(#e3e7eb, #c6c9ce); cursor: grab; touch-action: none }
figure.viewer canvas:active { cursor: grabbing }
.cutbar { display: flex; gap: .8em; align-items: center; justify-content: center; padding: .4em .8em; flex-wrap: wrap }
.cutbar input[type=range] { width: min(40vw, 22em) } .cutbar span { color: #606a75 }
)";

const char* const kViewerBar =
    R"(<div class="cutbar"><label>cut <select name="axis"><option value="-1">none</option><option value="0">x</option><option value="1">y</option><option value="2">z</option></select></label>
<input type="range" name="place" min="0" max="1" step="0.002" value="0.5" aria-label="where to cut" disabled>
<label><input type="checkbox" name="other" disabled> other half</label> <button type="button" name="back">reset</button> <span>drag: turn; wheel: nearer; shift or right button: move</span></div>
)";

const char* const kViewerScript = R"(<script>
"use strict";
(() => {
  const vertexText = `
    attribute vec3 place; attribute vec2 octahedral; attribute float open; attribute vec3 colour;
    uniform mat4 view; uniform vec4 lens; uniform vec3 low, side, middle; uniform float shrink;
    varying vec3 normal, at, tint, world; varying float sky;
    vec3 unfolded(vec2 o) {
      o = max(o / 127.0, -1.0);
      vec3 n = vec3(o, 1.0 - abs(o.x) - abs(o.y));
      if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
      return normalize(n);
    }
    void main() {
      world = place;
      vec4 p = view * vec4((low + place * side - middle) * shrink, 1.0);
      normal = mat3(view) * unfolded(octahedral);
      at = p.xyz; sky = open; tint = colour;
      gl_Position = vec4(p.x * lens.x, p.y * lens.y, -p.z * lens.z - lens.w, -p.z);
    }`;
  const pixelText = `
    precision highp float;
    varying vec3 normal, at, tint, world; varying float sky;
    uniform int axis; uniform float cut, half_; uniform vec3 up;
    void main() {
      float along = axis == 0 ? world.x : axis == 1 ? world.y : world.z;
      if (axis >= 0 && (along - cut) * half_ > 0.0) discard;
      vec3 albedo = pow(tint, vec3(2.2)), towards = normalize(-at), n = normalize(normal), light;
      if (!gl_FrontFacing) {
        // The inside, seen through the cut, is drawn as the cut's face.
        light = vec3(0.50, 0.20, 0.09);
      } else {
        if (dot(n, towards) < 0.0) n = -n;
        vec3 sun = normalize(vec3(-0.62, 0.72, 0.62)), behind = normalize(vec3(0.8, 0.3, -0.6));
        float key = max(dot(n, sun), 0.0) * mix(0.45, 1.0, smoothstep(0.1, 0.7, sky)), height = dot(n, up);
        vec3 dome = mix(vec3(0.36, 0.33, 0.31), vec3(0.74, 0.80, 0.90), 0.5 + 0.5 * height) * sky + 0.12 * (1.0 - sky);
        light = albedo * (vec3(1.12, 1.05, 0.96) * key + dome * 0.66 + vec3(0.30, 0.34, 0.40) * max(dot(n, behind), 0.0) * sky);
        float gloss = max(dot(n, normalize(sun + towards)), 0.0);
        light += vec3(0.10) * pow(gloss, 24.0) * key + vec3(0.12, 0.13, 0.15) * pow(1.0 - max(dot(n, towards), 0.0), 4.0) * sky;
      }
      gl_FragColor = vec4(pow(min(light, 1.0), vec3(1.0 / 2.2)), 1.0);
    }`;

  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const unit = a => { const l = Math.sqrt(dot(a, a)) || 1; return a.map(x => x / l); };

  // For links and tests: #cut=x,0.5&turn=1&check
  const wanted = new URLSearchParams(location.hash.slice(1));
  // What all viewers of the page share: how far the view is turned from the first one, and the cut.
  const fresh = () => ({ turn: 0, tilt: 0, near: 1, moveX: 0, moveY: 0 });
  const shared = Object.assign(fresh(), { axis: -1, cut: 0.5, half: 1 });
  const viewers = [];
  const drawAll = () => { for (const viewer of viewers) viewer.draw(); };
  let asked = false;
  const ask = () => { if (!asked) { asked = true; requestAnimationFrame(() => { asked = false; drawAll(); }); } };

  function unpacked(figure) {
    const about = JSON.parse(figure.dataset.mesh), n = about.vertices;
    const text = atob(figure.querySelector("script").textContent.trim()), bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
    let at = 0;
    const next = size => bytes.slice(at, at += size);
    const mesh = { about, places: new Uint16Array(next(6 * n).buffer), normals: new Int8Array(next(2 * n).buffer), open: next(n) };
    mesh.colours = about.coloured ? next(3 * n) : null;
    mesh.corners = new Uint32Array(3 * about.triangles);
    let met = 0;
    for (let i = 0; i < mesh.corners.length; ++i) {
      let value = 0, shift = 0, byte;
      do { byte = bytes[at++]; value |= (byte & 127) << shift; shift += 7; } while (byte & 128);
      if (value === 0) mesh.corners[i] = met++; else mesh.corners[i] = met - value;
    }
    return mesh;
  }

  function program(gl) {
    const made = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertexText], [gl.FRAGMENT_SHADER, pixelText]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(made, shader);
    }
    gl.linkProgram(made);
    if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
    gl.useProgram(made);
    return made;
  }

  function upload(gl, made, mesh) {
    const attribute = (name, data, size, type, normalised) => {
      const place = gl.getAttribLocation(made, name);
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, type, normalised, 0, 0);
    };
    attribute("place", mesh.places, 3, gl.UNSIGNED_SHORT, true);
    attribute("octahedral", mesh.normals, 2, gl.BYTE, false);
    attribute("open", mesh.open, 1, gl.UNSIGNED_BYTE, true);
    if (mesh.colours) attribute("colour", mesh.colours, 3, gl.UNSIGNED_BYTE, true);
    else gl.vertexAttrib3f(gl.getAttribLocation(made, "colour"), 0.755, 0.668, 0.594);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, mesh.corners, gl.STATIC_DRAW);
  }

  function viewer(figure) {
    const mesh = unpacked(figure), about = mesh.about, canvas = document.createElement("canvas");
    const gl = canvas.getContext("webgl2", { antialias: true }) || canvas.getContext("webgl", { antialias: true });
    if (!gl || !(gl instanceof WebGLRenderingContext ? gl.getExtension("OES_element_index_uint") : true)) {
      figure.dataset.drawn = "none";
      const note = document.createElement("p");
      note.textContent = "This browser has no WebGL, so the model cannot be turned.";
      figure.prepend(note);
      return null;
    }
    figure.querySelector("img")?.remove();
    figure.prepend(canvas);
    const made = program(gl), place = name => gl.getUniformLocation(made, name);
    upload(gl, made, mesh);
    const side = about.high.map((h, i) => h - about.low[i]), middle = about.high.map((h, i) => (h + about.low[i]) / 2);
    const shrink = 2 / (Math.sqrt(dot(side, side)) || 1);
    const upright = about.up === "y" ? [0, 1, 0] : [0, 0, 1], across = about.up === "y" ? [[0, 0, 1], [1, 0, 0]] : [[1, 0, 0], [0, 1, 0]];
    const first = unit(about.view);
    const turn0 = Math.atan2(dot(first, across[1]), dot(first, across[0])), tilt0 = Math.asin(Math.max(-1, Math.min(1, dot(first, upright))));
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(0, 0, 0, 0);

    function draw() {
      const dense = Math.min(2, window.devicePixelRatio || 1), box = canvas.getBoundingClientRect();
      const width = Math.max(1, Math.round(box.width * dense)), height = Math.max(1, Math.round(box.height * dense));
      if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
      gl.viewport(0, 0, width, height);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      const tilt = Math.max(-1.5707, Math.min(1.5707, tilt0 + shared.tilt)), turn = turn0 + shared.turn;
      const back = [0, 1, 2].map(i => Math.cos(tilt) * (Math.cos(turn) * across[0][i] + Math.sin(turn) * across[1][i]) + Math.sin(tilt) * upright[i]);
      const right = unit(cross(upright, back)), up = cross(back, right), distance = 4.0 * shared.near;
      gl.uniformMatrix4fv(place("view"), false, [right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0,
        shared.moveX, shared.moveY, -distance, 1]);
      const span = 0.26 * Math.max(1, height / width), far = distance + 4, near = Math.max(0.02, distance - 4);
      gl.uniform4f(place("lens"), height / width / span, 1 / span, (far + near) / (far - near), 2 * far * near / (far - near));
      gl.uniform3fv(place("low"), about.low); gl.uniform3fv(place("side"), side); gl.uniform3fv(place("middle"), middle);
      gl.uniform1f(place("shrink"), shrink);
      gl.uniform3f(place("up"), dot(upright, right), dot(upright, up), dot(upright, back));
      gl.uniform1i(place("axis"), shared.axis); gl.uniform1f(place("cut"), shared.cut); gl.uniform1f(place("half_"), shared.half);
      gl.drawElements(gl.TRIANGLES, mesh.corners.length, gl.UNSIGNED_INT, 0);
      if (wanted.has("check") && figure.dataset.drawn === undefined) {
        const pixels = new Uint8Array(4 * width * height);
        gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
        let covered = 0;
        for (let i = 3; i < pixels.length; i += 4) covered += pixels[i] > 0;
        figure.dataset.drawn = covered;
      }
    }
    listen(canvas);
    new ResizeObserver(ask).observe(canvas);
    return { draw };
  }

  // Drag and wheel; two fingers come nearer as they part.
  function listen(canvas) {
    const fingers = new Map();
    const apart = () => { const [a, b] = [...fingers.values()]; return Math.hypot(a.x - b.x, a.y - b.y); };
    const nearer = factor => { shared.near = Math.max(0.05, Math.min(6, shared.near * factor)); ask(); };
    canvas.addEventListener("pointerdown", event => { canvas.setPointerCapture(event.pointerId); fingers.set(event.pointerId, { x: event.clientX, y: event.clientY }); });
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, event => fingers.delete(event.pointerId));
    canvas.addEventListener("pointermove", event => {
      const last = fingers.get(event.pointerId);
      if (!last) return;
      const dx = event.clientX - last.x, dy = event.clientY - last.y, before = fingers.size === 2 ? apart() : 0;
      fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
      if (fingers.size === 2) return nearer(before / Math.max(1, apart()));
      if (event.shiftKey || event.buttons & 2) {
        const scale = 2 * 0.26 * 4.0 * shared.near / canvas.clientHeight;
        shared.moveX += dx * scale; shared.moveY -= dy * scale;
      } else {
        shared.turn -= dx * 0.008; shared.tilt += dy * 0.008;
      }
      ask();
    });
    canvas.addEventListener("contextmenu", event => event.preventDefault());
    canvas.addEventListener("wheel", event => { event.preventDefault(); nearer(Math.exp(Math.max(-60, Math.min(60, event.deltaY)) * 0.0025)); }, { passive: false });
  }

  const bar = document.querySelector(".cutbar"), [axis, range, other, reset] = ["axis", "place", "other", "back"].map(name => bar.querySelector(`[name=${name}]`));
  const cut = () => {
    shared.axis = +axis.value; shared.cut = +range.value; shared.half = other.checked ? -1 : 1;
    range.disabled = other.disabled = shared.axis < 0;
    ask();
  };
  for (const part of [axis, range, other]) part.addEventListener("input", cut);
  reset.addEventListener("click", () => { Object.assign(shared, fresh()); axis.value = "-1"; range.value = 0.5; other.checked = false; cut(); });
  if (wanted.get("cut")) {
    const [name, where] = wanted.get("cut").split(",");
    axis.value = String("xyz".indexOf(name)); range.value = where || 0.5;
  }
  shared.turn = +(wanted.get("turn") || 0);
  for (const figure of document.querySelectorAll("figure.viewer")) {
    const made = viewer(figure);
    if (made) viewers.push(made);
  }
  cut();
  drawAll();
  document.body.dataset.viewers = viewers.length;
})();
</script>)";

}  // namespace vdbsynth::cli
