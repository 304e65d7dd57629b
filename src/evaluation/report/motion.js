// Motion as the report holds it: the inverse of encode_series (src/evaluation/motion_code.cpp).
const MISSING = -100000;

function decodeSeries(text, rows) {
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  const columns = [];
  for (let at = 0; at < bytes.length;) {
    const column = new Float32Array(rows);
    let before = 0, last = 0;
    for (let row = 0; row < rows; ++row) {
      let value = 0, scale = 1, byte;
      do {
        byte = bytes[at++];
        value += (byte & 127) * scale;
        scale *= 128;
      } while (byte & 128);
      const residue = value % 2 ? -(value + 1) / 2 : value / 2;
      const now = residue + (row === 0 ? 0 : row === 1 ? last : 2 * last - before);
      column[row] = now === MISSING ? NaN : now;
      before = last;
      last = now;
    }
    columns.push(column);
  }
  return columns;
}

// One value of a column between two frames; at a gap, that of the nearer frame.
function valueAt(column, frame) {
  const i = Math.min(Math.floor(frame), column.length - 1), j = Math.min(i + 1, column.length - 1);
  const part = frame - i;
  const mixed = column[i] * (1 - part) + column[j] * part;
  return Number.isNaN(mixed) ? column[part < .5 ? i : j] : mixed;
}

class Clip {
  constructor(data) {
    Object.assign(this, data);
    this.truth = decodeSeries(data.truth, data.frames);
    this.track = decodeSeries(data.track, data.frames);
    this.ground = Math.min(...this.truth.filter((_, i) => i % 3 === 1).map(column => Math.min(...column)));
    this.sides = data.sides;
    this.motions = data.motions.map(motion => ({...motion, columns: null}));
  }
  motion(index) {
    const motion = this.motions[index];
    motion.columns ??= decodeSeries(motion.points_mm, this.frames);
    motion.errors ??= this.errorPerFrame(motion.columns);
    if (motion.deviation_mm) motion.deviations ??= decodeSeries(motion.deviation_mm, this.frames);
    return motion;
  }
  // Distance of a joint from the truth, roots aligned; an end of a limb counts as its joint.
  jointError(columns, point, frame) {
    const joint = point < this.joints ? point : this.parents[point];
    let sum = 0;
    for (let axis = 0; axis < 3; ++axis) {
      const off = valueAt(columns[3 * joint + axis], frame) - valueAt(columns[axis], frame) -
        valueAt(this.truth[3 * joint + axis], frame) + valueAt(this.truth[axis], frame);
      sum += off * off;
    }
    return Math.sqrt(sum);
  }
  errorPerFrame(columns) {
    const errors = new Float32Array(this.frames);
    for (let frame = 0; frame < this.frames; ++frame) {
      let sum = 0;
      for (let joint = 1; joint < this.joints; ++joint) sum += this.jointError(columns, joint, frame);
      errors[frame] = sum / (this.joints - 1);
    }
    return errors;
  }
}
