/* The numbers of the program, and their thinning to what a picture can show. */

const KINDS = { f4: Float32Array, u1: Uint8Array, u4: Uint32Array };

/** The array that Python packed. */
function unpack({ dtype, bdata }) {
  const bytes = Uint8Array.from(atob(bdata), (letter) => letter.charCodeAt(0));
  return new KINDS[dtype](bytes.buffer);
}

/** A number with four digits, as people write it. */
function number(value) {
  if (Math.abs(value) < 5e-4) return "0";
  return String(Number(value.toPrecision(4))).replace("-", "\u2212");
}

/** What is known of every sample; a sample stands for `step` ticks in a row. */
class Samples {
  constructor(data) {
    this.step = data.step;
    this.ticks = data.ticks;
    this.rate = data.rate;
    this.count = Math.ceil(data.ticks / data.step);
    this.time = Float64Array.from({ length: this.count }, (_, i) => (i * data.step) / data.rate);
    this.series = Object.fromEntries(Object.entries(data.series).map(([name, parts]) => [name, parts.map(unpack)]));
    this.place = data.place ? data.place.map(unpack) : null;
    this.limit = unpack(data.limit);
    this.block = unpack(data.blocks.at);
  }

  has(name, i) {
    return name in this.series && !Number.isNaN(this.series[name][0][i]);
  }

  /** The value of a series at a sample, or its smallest and largest. */
  words(name, i) {
    const [low, high] = this.series[name].map((part) => number(part[i]));
    return high === undefined || high === low ? low : `${low} to ${high}`;
  }

  /** The sample at a time, s. */
  at(time) {
    const i = Math.round((time * this.rate) / this.step);
    return Math.min(Math.max(i, 0), this.count - 1);
  }
}

/** The first index of the rising `x` whose value is not below `value`. */
function lowerBound(x, value) {
  let [low, high] = [0, x.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (x[middle] < value) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** The first and the last index of what is seen of the rising `x`, and one more on either side. */
function seen(x, [left, right]) {
  const first = Math.max(lowerBound(x, left) - 1, 0);
  return [first, Math.min(lowerBound(x, right), x.length - 1)];
}

/**
 * What is seen of a series, as points of a line: every sample where there is room for them, else the smallest and the
 * largest of every column, in their order.
 */
function thinned(x, [low, high = low], range, columns) {
  const [first, last] = seen(x, range);
  const count = last - first + 1;
  const line = { x: [], y: [] };
  const put = (i, value) => {
    line.x.push(x[i]);
    line.y.push(Number.isNaN(value) ? null : value);
  };
  const cells = Math.min(count, count > 2 * columns ? columns : count);
  for (let cell = 0; cell < cells; cell++) {
    const start = first + Math.floor((cell * count) / cells);
    const end = first + Math.floor(((cell + 1) * count) / cells);
    let [least, most] = [start, start];
    for (let i = start; i < end; i++) {
      if (low[i] < low[least] || Number.isNaN(low[least])) least = i;
      if (high[i] > high[most] || Number.isNaN(high[most])) most = i;
    }
    if (least <= most) put(least, low[least]);
    if (least !== most || high !== low) put(most, high[most]);
    if (least > most) put(least, low[least]);
  }
  return line;
}
