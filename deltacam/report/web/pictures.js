/* The two pictures in the plane of the sheet: the part with the path of the tool, and the machine from above. */

const MOST_DOTS = 2000; // setpoints that are drawn as dots
const REACH = 30; // pixels from the pointer to the path

/** The part, with the path in the colours of one of the colourings. */
class Part {
  constructor(figure, data, samples, config) {
    this.figure = figure;
    this.data = data.part;
    this.samples = samples;
    this.colourings = data.colourings;
    this.route = data.route && {
      x: unpack(data.route.x),
      y: unpack(data.route.y),
      first: unpack(data.route.first),
      band: unpack(data.route.band),
      colours: data.route.colours.map(unpack),
    };
    this.mark = null;
    this.marks = this.data.marks.map(({ trace, scale }) => new Marks(trace, unpack(scale)));
    Plotly.newPlot(figure, this.traces(0), this.data.layout, { ...config, scrollZoom: true });
    this.overlay = new Overlay(figure);
    figure.on("plotly_relayout", () => this.showSetpoints());
    figure.on("plotly_afterplot", () => this.showMarks());
    this.showMarks();
  }

  traces(colouring) {
    const path = this.route ? this.path(colouring) : [];
    this.dots = this.data.below.length + path.length;
    const dots = { type: "scatter", mode: "markers", x: [], y: [], marker: { size: 3.5, color: this.data.dots } };
    const marks = this.marks.map((one) => one.shown);
    return [...this.data.below, ...path, dots, ...this.data.above, ...marks];
  }

  /** A trace for every colour and stroke, those that are rare on top; the rapids at the bottom. */
  path(chosen) {
    const { x, y, first, band, colours } = this.route;
    const { strokes } = this.data;
    const traces = new Map();
    for (let stretch = 0; stretch < first.length; stretch++) {
      const color = this.colourings[chosen].colors[colours[chosen][stretch]];
      const key = `${band[stretch]} ${strokes[band[stretch]].color ?? color}`;
      if (!traces.has(key)) traces.set(key, this.trace({ color, ...strokes[band[stretch]] }));
      const trace = traces.get(key);
      const end = stretch + 1 < first.length ? first[stretch + 1] : x.length - 1;
      for (let i = first[stretch]; i <= end; i++) {
        trace.x.push(x[i]);
        trace.y.push(y[i]);
      }
      trace.x.push(null);
      trace.y.push(null);
    }
    const rank = ({ line, x }) => (line.dash === "solid" ? x.length : 1e9 + x.length);
    return [...traces.values()].sort((a, b) => rank(b) - rank(a));
  }

  trace(line) {
    return { type: "scatter", mode: "lines", x: [], y: [], line };
  }

  colour(chosen) {
    Plotly.react(this.figure, this.traces(chosen), this.figure.layout);
    this.showSetpoints();
  }

  /** The numbers and arrows that have room at this scale. */
  showMarks() {
    const { xaxis } = this.figure._fullLayout;
    const perPixel = Math.abs(xaxis.p2d(1) - xaxis.p2d(0));
    const first = this.dots + 1 + this.data.above.length;
    this.marks.forEach((one, i) => one.choose(perPixel) && Plotly.restyle(this.figure, one.change, [first + i]));
  }

  /** The setpoints as dots, once so few are seen that they can be told apart. */
  showSetpoints() {
    if (!this.samples.place || this.samples.step > 1) return;
    const [px, py] = this.samples.place;
    const { xaxis, yaxis } = this.figure._fullLayout;
    const [x, y] = [[], []];
    for (let i = 0; i < px.length && x.length <= MOST_DOTS; i++) {
      const inside = px[i] >= xaxis.range[0] && px[i] <= xaxis.range[1];
      if (!inside || py[i] < yaxis.range[0] || py[i] > yaxis.range[1]) continue;
      x.push(px[i]);
      y.push(py[i]);
    }
    const few = x.length <= MOST_DOTS && x.length < px.length / 2;
    Plotly.restyle(this.figure, { x: [few ? x : []], y: [few ? y : []] }, [this.dots]);
  }

  /** The sample that is nearest to a place, or null where none is near. */
  pick({ x, y, perPixel }) {
    if (!this.samples.place) return null;
    const [px, py] = this.samples.place;
    let [best, square] = [null, (REACH * perPixel) ** 2];
    for (let i = 0; i < px.length; i++) {
      const gap = (px[i] - x) ** 2 + (py[i] - y) ** 2;
      if (gap < square) [best, square] = [i, gap];
    }
    return best;
  }

  place(i) {
    return this.samples.place ? this.samples.place.map((column) => column[i]) : null;
  }

  draw(i) {
    this.overlay.dot("mark", this.mark, 11);
    this.overlay.dot("tool", this.place(i), 6);
  }

  /** Mark a place, mm, and go near. */
  goTo(place) {
    this.mark = place;
    const { range } = this.data.layout.xaxis;
    const half = Math.max((range[1] - range[0]) / 16, 0.5);
    const around = (middle) => [middle - half, middle + half];
    return Plotly.relayout(this.figure, { "xaxis.range": around(place[0]), "yaxis.range": around(place[1]) });
  }
}

/** Marks of which some are shown, by the scale of the picture: of each it is known from which one on it has room. */
class Marks {
  constructor(trace, scale) {
    this.all = { x: unpack(trace.x), y: unpack(trace.y), text: trace.text, side: trace.textposition };
    this.angle = trace.marker.angle;
    this.scale = scale;
    this.shown = { ...trace, x: [], y: [] };
    this.count = 0;
  }

  /** Whether others than before are shown where a pixel is so many mm. */
  choose(perPixel) {
    const chosen = [...this.scale.keys()].filter((i) => perPixel <= this.scale[i]);
    if (chosen.length === this.count) return false;
    this.count = chosen.length;
    const of = (values) => values && chosen.map((i) => values[i]);
    const { x, y, text, side } = this.all;
    this.change = { x: [of(x)], y: [of(y)] };
    if (text) Object.assign(this.change, { text: [of(text)], textposition: [of(side)] });
    if (this.angle) this.change["marker.angle"] = [of(this.angle)];
    const marker = { ...this.shown.marker, ...(this.angle && { angle: of(this.angle) }) };
    Object.assign(this.shown, { x: of(x), y: of(y), text: of(text), textposition: of(side), marker });
    return true;
  }
}

/** The machine from above; its arms follow the tool. */
class Workspace {
  constructor(figure, data, part, config) {
    this.figure = figure;
    this.data = data.workspace;
    this.part = part;
    Plotly.newPlot(figure, this.data.traces, this.data.layout, { ...config, scrollZoom: true });
    this.overlay = new Overlay(figure);
  }

  turn([x, y], angle) {
    const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
    return [cos * x - sin * y, sin * x + cos * y];
  }

  pick({ x, y, perPixel }) {
    const { placement } = this.data;
    const [sx, sy] = this.turn([x - placement.x, y - placement.y], -placement.rotation);
    return this.part.pick({ x: sx, y: sy, perPixel });
  }

  draw(i) {
    const place = this.part.place(i);
    const tool = place && this.toBase(place);
    const arms = tool ? this.arms(i, tool) : [];
    arms.forEach(([shoulder, elbow, wrist], joint) => {
      this.overlay.draw(`forearm joint${joint + 1}`, "path", { d: `M${elbow.join(" ")}L${wrist.join(" ")}` });
      this.overlay.draw(`upperarm joint${joint + 1}`, "path", { d: `M${shoulder.join(" ")}L${elbow.join(" ")}` });
    });
    this.overlay.dot("tool", tool, 5);
  }

  toBase(place) {
    const { x, y, rotation } = this.data.placement;
    const turned = this.turn(place, rotation);
    return [turned[0] + x, turned[1] + y];
  }

  /** Shoulder, elbow and wrist of every arm, in pixels: the elbow lies in the vertical plane of its joint. */
  arms(i, tool) {
    const { centre, azimuths, base, upper, effector } = this.data.arms;
    const from = ([x, y], [dx, dy]) => [x + dx, y + dy];
    return azimuths.map((azimuth, joint) => {
      const angle = (this.part.samples.series[`angle ${joint + 1}`][0][i] * Math.PI) / 180;
      const elbow = base[joint] + upper[joint] * Math.cos(angle);
      const along = [base[joint], elbow].map((reach) => from(centre, this.turn([reach, 0], azimuth)));
      const wrist = from(tool, this.turn([effector[joint], 0], azimuth));
      return [...along, wrist].map(([x, y]) => this.overlay.pixel(x, y));
    });
  }
}
