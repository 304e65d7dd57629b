// Centre and larger side of the box around points.
function boundsOf(points) {
  const range = axis => [Math.min(...points.map(p => p[axis])), Math.max(...points.map(p => p[axis]))];
  const [left, right] = range("x"), [top, bottom] = range("y");
  return {x: (left + right) / 2, y: (top + bottom) / 2, size: Math.max(right - left, bottom - top)};
}

// The player: what is chosen, what time it is, and drawing it.
class Viewer {
  constructor(clips) {
    this.sources = clips;
    this.loaded = new Map();
    this.root = document.querySelector(".viewer");
    this.part = id => document.getElementById(id);
    this.scene = new Scene(this.part("scene"));
    this.input = new Scene(this.part("input"));
    this.strip = new Scene(this.part("strip"));
    this.frame = 0;
    this.playing = false;
    const stops = [0, 25, 50, 75, 100, 125, 150].map(errorColour).join(",");
    this.part("legend").querySelector("i").style.background = `linear-gradient(90deg, ${stops})`;
    this.fillClips();
    this.listen();
    this.choose(0);
  }
  fillClips() {
    const groups = new Map();
    this.sources.forEach((clip, index) => {
      if (!groups.has(clip.action)) groups.set(clip.action, element("optgroup", {label: clip.action}));
      groups.get(clip.action).append(element("option", {value: index}, clip.name + (clip.trained_on ? " (trained on)" : "")));
    });
    this.part("clip").append(...groups.values());
  }
  listen() {
    const on = (id, event, act) => this.part(id).addEventListener(event, act);
    on("clip", "change", e => this.choose(+e.target.value));
    on("motion", "change", () => this.chooseMotion());
    on("play", "click", () => this.toggle());
    on("scrub", "input", e => this.seek(+e.target.value));
    on("error", "change", () => this.draw());
    on("align", "change", () => this.draw());
    on("sure", "change", () => this.draw());
    on("closer", "click", () => this.zoom(1.15));
    on("farther", "click", () => this.zoom(1 / 1.15));
    for (const radio of this.root.querySelectorAll("[name=layout]")) radio.addEventListener("change", () => this.draw());
    const canvas = this.part("scene");
    let held = null;  // where the pointer was last: not every browser reports how far it moved
    canvas.addEventListener("pointerdown", e => {
      canvas.setPointerCapture(e.pointerId);
      held = {x: e.clientX, y: e.clientY};
    });
    canvas.addEventListener("pointermove", e => {
      if (!canvas.hasPointerCapture(e.pointerId)) return;
      this.scene.orbit.turn((e.clientX - held.x) * .009, (e.clientY - held.y) * .006);
      held = {x: e.clientX, y: e.clientY};
      this.draw();
    });
    const seekTo = e => {
      const box = this.part("strip").getBoundingClientRect();
      this.seek(Math.round((e.clientX - box.left) / box.width * (this.clip.frames - 1)));
    };
    on("strip", "pointerdown", seekTo);
    on("strip", "pointermove", e => { if (e.buttons) seekTo(e); });
    document.addEventListener("keydown", e => this.key(e));
    const redraw = () => this.draw();
    new ResizeObserver(redraw).observe(canvas);
    new MutationObserver(redraw).observe(document.documentElement, {attributeFilter: ["data-theme"]});
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  }
  key(e) {
    if (e.ctrlKey || e.metaKey || e.altKey || e.target.closest("select, input[type=radio], input[type=range]")) return;
    const arrow = {ArrowLeft: -1, ArrowRight: 1}[e.key], press = id => this.part(id).click();
    if (e.key === " " && !e.target.closest("button, summary, input")) { if (!e.repeat) this.toggle(); }
    else if (arrow && e.shiftKey) { this.scene.orbit.turn(-arrow * .15, 0); this.draw(); }
    else if (arrow && !e.target.closest(".scroll")) { this.pause(); this.seek(Math.round(this.frame) + arrow); }
    else if (e.key === "+" || e.key === "=") this.zoom(1.15);
    else if (e.key === "-") this.zoom(1 / 1.15);
    else if (e.key === "[" || e.key === "]") this.changeSpeed(e.key === "]" ? 1 : -1);
    else if (e.key === "n" || e.key === "p") this.choose((this.index + (e.key === "n" ? 1 : this.sources.length - 1)) % this.sources.length);
    else if (e.key === "o") { this.root.querySelector(`[value=${this.overlaid ? "side" : "overlay"}]`).click(); }
    else if (e.key === "e") press("error");
    else if (e.key === "u") press("sure");
    else return;
    e.preventDefault();
  }
  get overlaid() { return this.root.querySelector("[name=layout]:checked").value === "overlay"; }

  choose(index) {
    this.index = index;
    if (!this.loaded.has(index)) this.loaded.set(index, new Clip(this.sources[index]));
    this.clip = this.loaded.get(index);
    this.part("clip").value = index;
    const before = this.part("motion").selectedOptions[0]?.dataset.label;
    this.part("motion").replaceChildren(...this.clip.motions.map((motion, i) => element("option",
      {value: i, "data-label": motion.label}, `${motion.label.replaceAll("_", " ")}, ${motion.mpjpe_mm.toFixed(1)} mm`)));
    const same = this.clip.motions.findIndex(motion => motion.label === before);
    this.part("motion").value = Math.max(0, same);
    this.part("scrub").max = this.clip.frames - 1;
    this.frame = 0;
    this.root.dataset.clip = this.clip.name;
    this.chooseMotion();
  }
  chooseMotion() {
    this.motion = this.clip.motion(+this.part("motion").value);
    this.root.dataset.motion = this.motion.label;
    this.part("sure").disabled = !this.motion.deviations;
    this.draw();
  }
  seek(frame) {
    this.frame = Math.max(0, Math.min(this.clip.frames - 1, frame));
    this.draw();
  }
  changeSpeed(by) {
    const speed = this.part("speed");
    speed.selectedIndex = Math.max(0, Math.min(speed.length - 1, speed.selectedIndex + by));
  }
  zoom(by) {
    this.scene.orbit.zoom = Math.max(.4, Math.min(4, this.scene.orbit.zoom * by));
    this.draw();
  }
  toggle() { this.playing ? this.pause() : this.play(); }
  play() {
    this.playing = true;
    let last = performance.now();
    const step = now => {
      const frames = (now - last) / 1000 * this.clip.fps * +this.part("speed").value;
      last = now;
      this.frame += Math.max(0, frames);
      if (this.frame >= this.clip.frames - 1) this.frame = 0;
      this.draw();
      this.asked = requestAnimationFrame(step);
    };
    this.asked = requestAnimationFrame(step);
    this.showPlaying();
  }
  pause() {
    this.playing = false;
    cancelAnimationFrame(this.asked);  // else it would go on beside that of the next play
    this.showPlaying();
  }
  showPlaying() {
    this.part("play").textContent = this.playing ? "❚❚ Pause" : "▶ Play";
    this.part("play").setAttribute("aria-pressed", this.playing);
  }

  pointsOf(columns) {
    return this.clip.points.map((_, i) => [0, 1, 2].map(axis => valueAt(columns[3 * i + axis], this.frame)));
  }
  deviationsOf(columns) {
    return Array.from({length: this.clip.joints}, (_, i) => [0, 1, 2].map(axis => valueAt(columns[3 * i + axis], this.frame)));
  }
  draw() {
    if (!this.scene.fit()) return;
    const truth = this.pointsOf(this.clip.truth), other = this.pointsOf(this.motion.columns);
    const aligned = this.part("align").checked, byError = this.part("error").checked;
    if (aligned) this.putAt(other, truth[0]);
    const target = [truth[0][0], this.clip.ground + .5 * BODY_MM, truth[0][2]];
    const shade = name => point => this.sideColour(name, this.clip.sides[point]);
    const otherColour = byError ? point => errorColour(this.clip.jointError(this.motion.columns, point, this.frame)) : shade("other");
    const figures = [{points: truth, colour: shade("truth"), label: "Truth", name: "truth"},
                     {points: other, colour: otherColour, label: this.motion.label.replaceAll("_", " "), name: "other"}];
    const panels = this.overlaid ? 1 : 2;
    figures.forEach((figure, i) => {
      const panel = this.scene.panel(this.overlaid ? 0 : i, panels);
      this.scene.clipTo(panel, () => {
        if (i < panels) this.scene.ground(panel, target, this.clip.ground);
        if (figure.name === "other" && this.motion.deviations && this.part("sure").checked)
          this.scene.intervals(panel, target, this.clip, figure.points, this.deviationsOf(this.motion.deviations),
                               this.scene.colour("other"));
        this.scene.figure(panel, target, this.clip, figure.points, this.clip.ground, figure.colour,
                          this.overlaid && i === 0 ? .75 : 1);
        const at = this.overlaid ? {...panel, y: 20 * i} : panel;
        this.scene.label(at, figure.label, this.scene.colour(figure.name));
      });
    });
    this.part("legend").hidden = !byError;
    this.drawInput();
    this.drawStrip();
    this.showNumbers();
  }
  putAt(points, root) {
    const shift = root.map((value, axis) => value - points[0][axis]);
    for (const point of points) shift.forEach((value, axis) => { point[axis] += value; });
  }
  // The figure's left side paler, its right side full.
  sideColour(name, side) {
    const colour = this.scene.colour(name);
    return side < 0 ? `color-mix(in srgb, ${colour} 60%, ${this.scene.colour("panel")})`
      : side > 0 ? colour : `color-mix(in srgb, ${colour} 78%, ${this.scene.colour("ink")})`;
  }
  // The joints as large as they can be, and where in the whole image they are.
  drawInput() {
    if (!this.input.fit()) return;
    const {track, parents, joints} = this.clip, {context: c, width, height} = this.input;
    const at = joint => ({x: valueAt(track[2 * joint], this.frame), y: valueAt(track[2 * joint + 1], this.frame)});
    const all = Array.from({length: joints}, (_, joint) => at(joint)), seen = all.filter(p => Number.isFinite(p.x + p.y));
    if (seen.length === 0) return;
    const box = boundsOf(seen), scale = .85 * Math.min(width * 1.6, height) / this.largestInput();
    const onPanel = p => ({x: width / 2 + (p.x - box.x) * scale, y: height / 2 + (p.y - box.y) * scale});
    c.lineCap = "round";
    all.map(onPanel).forEach((to, joint, placed) => {
      const from = placed[parents[joint]];
      c.strokeStyle = c.fillStyle = this.sideColour("quiet", this.clip.sides[joint]);
      if (from && Number.isFinite(to.x + from.x)) this.input.segment(from, to, 2.5);
      if (!Number.isFinite(to.x)) return;
      c.beginPath();
      c.arc(to.x, to.y, 3.2, 0, 2 * Math.PI);
      c.fill();
    });
    this.drawImageMap(box);
  }
  // Over the whole clip, so that the figure keeps its size from frame to frame.
  largestInput() {
    const {track, joints, frames} = this.clip;
    this.clip.inputSize ??= Math.max(1, ...Array.from({length: Math.ceil(frames / 5)}, (_, i) => {
      const points = Array.from({length: joints}, (_, j) => ({x: track[2 * j][5 * i], y: track[2 * j + 1][5 * i]}));
      return boundsOf(points.filter(p => Number.isFinite(p.x + p.y))).size;
    }).filter(Number.isFinite));
    return this.clip.inputSize;
  }
  drawImageMap(box) {
    const {context: c, width} = this.input, w = 64, h = w * this.clip.height / this.clip.width;
    c.strokeStyle = this.input.colour("note");
    c.lineWidth = 1;
    c.strokeRect(width - w - 10, 10, w, h);
    c.fillStyle = this.input.colour("other");
    const size = Math.max(3, box.size / this.clip.width * w);
    c.fillRect(width - w - 10 + box.x / this.clip.width * w - 1.5, 10 + box.y / this.clip.height * h - size / 2, 3, size);
  }
  drawStrip() {
    if (!this.strip.fit()) return;
    const {context: c, width, height} = this.strip, errors = this.motion.errors;
    const highest = Math.max(60, ...errors), bar = width / errors.length;
    errors.forEach((error, frame) => {
      c.fillStyle = errorColour(error);
      const tall = Math.max(1, error / highest * (height - 4));
      c.globalAlpha = .8;
      c.fillRect(frame * bar, height - tall, bar + .6, tall);
    });
    c.globalAlpha = 1;
    c.fillStyle = this.strip.colour("ink");
    c.fillRect(this.frame / Math.max(1, this.clip.frames - 1) * (width - 2), 0, 2, height);
    c.font = "11px system-ui, sans-serif";
    c.fillStyle = this.strip.colour("quiet");
    c.fillText(`error of each frame, up to ${highest.toFixed(0)} mm`, 8, 13);
  }
  showNumbers() {
    const frame = Math.round(this.frame);
    this.root.dataset.frame = this.frame.toFixed(2);
    this.part("scrub").value = frame;
    this.part("scrub").setAttribute("aria-valuetext", `frame ${frame + 1} of ${this.clip.frames}`);
    this.part("clock").textContent = `${(this.frame / this.clip.fps).toFixed(2)} s · frame ${frame + 1} / ${this.clip.frames}`;
    let worst = 0, far = 0;
    for (let joint = 1; joint < this.clip.joints; ++joint) {
      const error = this.clip.jointError(this.motion.columns, joint, this.frame);
      if (error > far) [worst, far] = [joint, error];
    }
    this.part("worst").textContent = `off by ${this.motion.errors[frame].toFixed(0)} mm, most at ${this.clip.points[worst]}: ${far.toFixed(0)} mm`;
  }
}
