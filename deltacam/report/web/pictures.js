/* The two pictures in the plane of the sheet: the part with the path of the tool, and the machine from above. */

const RAPID = 0;
const ENGRAVED = 1;
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
    Plotly.newPlot(figure, this.traces(0), this.data.layout, { ...config, scrollZoom: true });
    this.overlay = new Overlay(figure);
    figure.on("plotly_relayout", () => this.showSetpoints());
  }

  traces(colouring) {
    const path = this.route ? this.path(colouring) : [];
    this.dots = this.data.below.length + path.length;
    const dots = { type: "scatter", mode: "markers", x: [], y: [], marker: { size: 3.5, color: this.data.dots } };
    return [...this.data.below, ...path, dots, ...this.data.above];
  }

  /** A trace for every colour, those that are rare on top; the rapids are dashed. */
  path(chosen) {
    const { x, y, first, band, colours } = this.route;
    const traces = new Map();
    for (let stretch = 0; stretch < first.length; stretch++) {
      const color = colours[chosen][stretch];
      const key = band[stretch] === RAPID ? "rapid" : `${band[stretch]} ${color}`;
      if (!traces.has(key)) traces.set(key, this.trace(band[stretch], this.colourings[chosen].colors[color]));
      const trace = traces.get(key);
      const end = stretch + 1 < first.length ? first[stretch + 1] : x.length - 1;
      for (let i = first[stretch]; i <= end; i++) {
        trace.x.push(x[i]);
        trace.y.push(y[i]);
      }
      trace.x.push(null);
      trace.y.push(null);
    }
    const rapid = traces.get("rapid");
    traces.delete("rapid");
    return [...(rapid ? [rapid] : []), ...[...traces.values()].sort((a, b) => b.x.length - a.x.length)];
  }

  trace(band, color) {
    const rapid = { color: this.data.rapid, width: 1, dash: "4px,4px" };
    const line = { color, width: band === ENGRAVED ? 1.5 : 2.6 };
    return { type: "scatter", mode: "lines", x: [], y: [], line: band === RAPID ? rapid : line };
  }

  colour(chosen) {
    Plotly.react(this.figure, this.traces(chosen), this.figure.layout);
    this.showSetpoints();
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
