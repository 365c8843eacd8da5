/* Series over time or length; what is seen is thinned anew whenever that changes. */

class Charts {
  /** `x` rises with the samples; `usable` says which samples have a place on it. */
  constructor(figure, data, samples, x, config, strip = null) {
    this.figure = figure;
    this.samples = samples;
    this.x = x;
    this.lines = data.lines;
    this.strip = strip;
    figure.style.height = `${data.height}px`;
    const traces = this.traces(data.layout.xaxis.range, figure.clientWidth);
    Plotly.newPlot(figure, traces, data.layout, config);
    this.overlay = new Overlay(figure);
    figure.on("plotly_relayout", () => this.thinAgain());
  }

  traces(range, columns) {
    const lines = this.lines.map(({ series, axis, color }) => ({
      type: "scatter",
      mode: "lines",
      yaxis: axis,
      line: { color, width: 1.2 },
      ...thinned(this.x, this.samples.series[series], range, columns),
    }));
    return this.strip ? [...this.strip.traces(this.samples, range, columns), ...lines] : lines;
  }

  thinAgain() {
    const { xaxis } = this.figure._fullLayout;
    const traces = this.traces(xaxis.range, Math.ceil(xaxis._length));
    const data = { x: traces.map((trace) => trace.x), y: traces.map((trace) => trace.y) };
    Plotly.restyle(this.figure, data, [...traces.keys()]);
  }

  pick({ x }) {
    return Math.min(lowerBound(this.x, x), this.samples.count - 1);
  }

  draw(i) {
    this.overlay.upright("time", this.x[i]);
  }
}

/** Which limit is nearest, and how much of it is used: an area of one colour while the limit is the same. */
class Strip {
  constructor(colors) {
    this.colors = colors;
  }

  traces(samples, range, columns) {
    const share = samples.series.share[samples.series.share.length - 1];
    const [first, last] = seen(samples.time, range);
    const cells = Math.min(columns, last - first + 1);
    const found = this.colors.map((color) => ({
      type: "scatter",
      mode: "lines",
      x: [],
      y: [],
      line: { width: 0 },
      fill: "toself",
      fillcolor: color,
    }));
    const close = (area) => {
      area?.x.push(area.x[area.x.length - 1], null);
      area?.y.push(0, null);
    };
    let open = null;
    for (let cell = 0; cell < cells; cell++) {
      const start = first + Math.floor((cell * (last - first + 1)) / cells);
      const end = first + Math.floor(((cell + 1) * (last - first + 1)) / cells);
      let most = start;
      for (let i = start; i < end; i++) if (share[i] > share[most]) most = i;
      const [left, right] = [samples.time[start], (end * samples.step) / samples.rate];
      const area = found[samples.limit[most]];
      if (area !== open) {
        close(open);
        area.x.push(left);
        area.y.push(0);
        open = area;
      }
      area.x.push(left, right);
      area.y.push(share[most], share[most]);
    }
    close(open);
    return found;
  }
}
