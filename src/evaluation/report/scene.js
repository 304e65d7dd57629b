// Draws stick figures on a canvas, seen by a camera that turns around them.
const BODY_MM = 1700;

class Orbit {
  constructor() { this.yaw = .55; this.pitch = .17; this.zoom = 1; }
  turn(dx, dy) {
    this.yaw -= dx;
    this.pitch = Math.max(-.3, Math.min(1.45, this.pitch + dy));
  }
  // World (mm) to pixels of a panel, with the distance for sizes.
  project(point, target, panel) {
    const [x, y, z] = [point[0] - target[0], point[1] - target[1], point[2] - target[2]];
    const cy = Math.cos(this.yaw), sy = Math.sin(this.yaw), cp = Math.cos(this.pitch), sp = Math.sin(this.pitch);
    const right = cy * x - sy * z, back = sy * x + cy * z;
    const up = cp * y - sp * back, near = sp * y + cp * back;
    const distance = 5200 - near, focal = 2.25 * Math.min(panel.height, panel.width * 1.7) * this.zoom;
    return {x: panel.x + panel.width / 2 + focal * right / distance,
            y: panel.y + panel.height * .5 - focal * up / distance, distance, scale: focal / distance};
  }
  // Deviations along the world's axes as the panel shows them: an ellipse's radii and its turn.
  ellipse(deviation) {
    const cy = Math.cos(this.yaw), sy = Math.sin(this.yaw), cp = Math.cos(this.pitch), sp = Math.sin(this.pitch);
    const right = [cy, 0, -sy], up = [-sp * sy, cp, -sp * cy];
    const sum = (a, b) => deviation.reduce((all, d, axis) => all + d * d * a[axis] * b[axis], 0);
    const across = sum(right, right), high = sum(up, up), both = sum(right, up);
    const middle = (across + high) / 2, spread = Math.hypot((across - high) / 2, both);
    return {wide: Math.sqrt(middle + spread), narrow: Math.sqrt(Math.max(0, middle - spread)),
            angle: -Math.atan2(2 * both, across - high) / 2};
  }
}

// Blue-green (near) over yellow to red (150 mm and more).
function errorColour(mm) {
  const stops = [[38, 166, 154], [242, 193, 58], [214, 57, 46]];
  const t = Math.min(1, mm / 150) * 2, i = Math.min(1, Math.floor(t)), part = t - i;
  return `rgb(${stops[i].map((c, k) => Math.round(c + (stops[i + 1][k] - c) * part)).join(" ")})`;
}

class Scene {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
    this.orbit = new Orbit();
  }
  // Matches the canvas to its size on the page; true if it is visible at all.
  fit() {
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
    if (this.canvas.width !== Math.round(width * ratio) || this.canvas.height !== Math.round(height * ratio)) {
      this.canvas.width = Math.round(width * ratio);
      this.canvas.height = Math.round(height * ratio);
    }
    this.context.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.width = width;
    this.height = height;
    this.context.clearRect(0, 0, width, height);
    const style = getComputedStyle(document.documentElement);
    this.colour = name => style.getPropertyValue(`--${name}`).trim();
    return width > 0 && height > 0;
  }
  panel(index, count) {
    const width = this.width / count;
    return {x: index * width, y: 0, width, height: this.height};
  }
  clipTo(panel, draw) {
    this.context.save();
    this.context.beginPath();
    this.context.rect(panel.x, panel.y, panel.width, panel.height);
    this.context.clip();
    draw();
    this.context.restore();
  }
  ground(panel, target, height) {
    const step = 500, reach = 2500, c = this.context;
    const middle = [Math.round(target[0] / step) * step, Math.round(target[2] / step) * step];
    c.strokeStyle = this.colour("grid");
    c.lineWidth = 1;
    const line = (from, to, fade) => {
      const a = this.orbit.project(from, target, panel), b = this.orbit.project(to, target, panel);
      if (a.distance < 100 || b.distance < 100) return;
      c.globalAlpha = fade;
      c.beginPath();
      c.moveTo(a.x, a.y);
      c.lineTo(b.x, b.y);
      c.stroke();
    };
    for (let i = -reach; i <= reach; i += step) {
      for (let j = -reach; j < reach; j += step) {
        const fade = Math.max(0, 1 - Math.hypot(i, j + step / 2) / reach) * .9;
        line([middle[0] + i, height, middle[1] + j], [middle[0] + i, height, middle[1] + j + step], fade);
        line([middle[0] + j, height, middle[1] + i], [middle[0] + j + step, height, middle[1] + i], fade);
      }
    }
    c.globalAlpha = 1;
  }
  // @param points [x, y, z] each; colourOf(point) a CSS colour
  figure(panel, target, clip, points, height, colourOf, opacity = 1) {
    const c = this.context, seen = points.map(p => this.orbit.project(p, target, panel));
    if (seen.some(p => p.distance < 100)) return;
    c.lineCap = "round";
    c.lineJoin = "round";
    const bones = clip.parents.map((from, to) => ({from, to})).filter(bone => bone.from >= 0);
    this.shadow(panel, target, bones, points, height);
    c.globalAlpha = opacity;
    const depth = bone => seen[bone.from].distance + seen[bone.to].distance;
    for (const bone of bones.sort((a, b) => depth(b) - depth(a))) {
      const [a, b] = [seen[bone.from], seen[bone.to]];
      const isHead = /head/i.test(clip.points[bone.to]) && bone.to >= clip.joints;
      c.strokeStyle = c.fillStyle = colourOf(bone.to);
      if (isHead) {
        c.beginPath();
        c.arc((a.x + b.x) / 2, (a.y + b.y) / 2, 95 * a.scale, 0, 2 * Math.PI);
        c.fill();
      } else {
        this.segment(a, b, Math.max(2.5, 42 * a.scale));
      }
    }
    c.globalAlpha = 1;
  }
  // Where nine of ten true joints are on the panel: around each bone the ellipses that its deviations
  // make there, filled as one, so that they are evenly pale. A share of 1 - exp(-reach² / 2) of a
  // normal distribution in two dimensions lies within `reach` deviations.
  // @param deviations [x, y, z] each, of the joints
  intervals(panel, target, clip, points, deviations, colour) {
    const c = this.context, steps = 8, reach = Math.sqrt(-2 * Math.log(.1));
    c.fillStyle = colour;
    c.globalAlpha = .28;
    c.beginPath();
    for (const [to, from] of clip.parents.entries()) {
      if (from < 0 || to >= clip.joints) continue;
      for (let step = 0; step <= steps; ++step) {
        const part = step / steps, mixed = (a, b) => a.map((value, axis) => value + (b[axis] - value) * part);
        const at = this.orbit.project(mixed(points[from], points[to]), target, panel);
        if (at.distance < 100) return;
        const seen = this.orbit.ellipse(mixed(deviations[from], deviations[to]));
        const [wide, narrow] = [seen.wide, seen.narrow].map(r => reach * r * at.scale);
        c.moveTo(at.x + wide * Math.cos(seen.angle), at.y + wide * Math.sin(seen.angle));
        c.ellipse(at.x, at.y, wide, narrow, seen.angle, 0, 2 * Math.PI);
      }
    }
    c.fill();
    c.globalAlpha = 1;
  }
  // On the ground below the figure, as one stroke, so that it is evenly dark.
  shadow(panel, target, bones, points, height) {
    const c = this.context;
    c.strokeStyle = this.colour("shadow");
    c.beginPath();
    let scale = 0;
    for (const {from, to} of bones) {
      const [a, b] = [from, to].map(i => this.orbit.project([points[i][0], height, points[i][2]], target, panel));
      c.moveTo(a.x, a.y);
      c.lineTo(b.x, b.y);
      scale = a.scale;
    }
    c.lineWidth = 70 * scale;
    c.stroke();
  }
  segment(a, b, width) {
    this.context.lineWidth = width;
    this.context.beginPath();
    this.context.moveTo(a.x, a.y);
    this.context.lineTo(b.x, b.y);
    this.context.stroke();
  }
  label(panel, text, colour) {
    const c = this.context;
    c.font = "600 14px system-ui, sans-serif";
    c.fillStyle = colour;
    c.fillText(text, panel.x + 16, panel.y + 27);
  }
}
