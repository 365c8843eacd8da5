/* Puts the pictures into the page and links them: what is pointed at in one of them is shown in all. */

/* These buttons and no others: plotly.js has some that send data away. */
const CONFIG = {
  responsive: true,
  displaylogo: false,
  doubleClick: "reset",
  showSendToCloud: false,
  plotlyServerURL: "",
  modeBarButtons: [["zoom2d", "pan2d", "zoomIn2d", "zoomOut2d", "resetScale2d"]],
};
const LONGEST_PLAY = 60; // s
const PAPER = 660; // pixels

/** The words for a sample: a list of names and values. */
function describe(data, samples, i) {
  const first = i * samples.step;
  const last = Math.min(first + samples.step, samples.ticks) - 1;
  const [kind, contour, layer, handle] = data.blocks.of[samples.block[i]];
  const rows = [
    ["time", `${samples.time[i].toFixed(4)} s`],
    [last > first ? "ticks" : "tick", last > first ? `${first} to ${last}` : String(first)],
  ];
  if (samples.place) rows.push(["x, y", samples.place.map((column) => column[i].toFixed(3)).join(", ") + " mm"]);
  if (samples.has("speed", i)) rows.push(["speed", `${samples.words("speed", i)} mm/s`]);
  if (samples.has("deviation", i)) rows.push(["deviation", `${samples.words("deviation", i)} \u00b5m`]);
  if (samples.has("energy", i)) rows.push(["energy per mm", `${samples.words("energy", i)} \u00d7 that at the feed`]);
  rows.push(["nearest limit", `${data.limits[samples.limit[i]] ?? "none"}, ${samples.words("share", i)} % used`]);
  rows.push(["does", kind]);
  if (contour !== null) {
    rows.push(["contour", String(contour)], ["layer", data.blocks.layers[layer]], ["handle", `#${handle}`]);
  }
  return rows;
}

/** The same with the motion of the joints. */
function describeJoints(data, samples, i) {
  const units = { angle: "\u00b0", "joint speed": "\u00b0/s", "joint acceleration": "\u00b0/s\u00b2", "joint jerk": "\u00b0/s\u00b3" };
  const joints = [1, 2, 3].map((joint) => [
    `joint ${joint}`,
    Object.entries(units).map(([name, unit]) => `${samples.words(`${name} ${joint}`, i)}${unit}`).join(", "),
  ]);
  return [...describe(data, samples, i), ...joints];
}

/** All pictures of the page, and what is shown in them. */
class Page {
  constructor(data) {
    this.data = data;
    this.samples = new Samples(data);
    this.tip = new Tip();
    this.now = 0;
    this.slider = document.getElementById("time");
    const figure = (name) => document.getElementById(name);
    this.buttons();
    this.size(figure("part"), figure("workspace"));
    window.addEventListener("resize", () => this.size(figure("part"), figure("workspace")));
    this.part = new Part(figure("part"), data, this.samples, CONFIG);
    this.workspace = new Workspace(figure("workspace"), data, this.part, CONFIG);
    const strip = new Strip(data.binding);
    this.motion = new Charts(figure("motion"), data.motion, this.samples, this.samples.time, CONFIG, strip);
    this.views = [this.part, this.workspace, this.motion];
    if (data.deviation) {
      const { worked } = this.samples.series;
      this.views.push(new Charts(figure("deviation"), data.deviation, this.samples, worked[0], CONFIG));
    }
    this.views.forEach((view) => this.follow(view));
    document.addEventListener("pointerdown", (event) => event.target.closest(".plot") || this.tip.hide());
    this.clock();
    this.places();
    this.printing();
  }

  /** The part as tall as it needs; the machine beside it just as tall, below it nearly square. */
  size(part, workspace) {
    const { xaxis, yaxis } = this.data.part.layout;
    const aspect = (yaxis.range[1] - yaxis.range[0]) / (xaxis.range[1] - xaxis.range[0]);
    const height = Math.min(Math.max((part.clientWidth - 50) * aspect + 38, 260), 600);
    part.style.height = `${height}px`;
    const beside = workspace.getBoundingClientRect().left > part.getBoundingClientRect().left + 50;
    workspace.style.height = beside ? "100%" : `${Math.min(workspace.clientWidth, 480)}px`;
  }

  follow(view) {
    const words = view === this.motion ? describeJoints : describe;
    const point = (event) => {
      const place = view.overlay.under(event);
      const i = place && view.pick(place);
      if (i === null) return this.tip.hide();
      this.show(i);
      return this.tip.show(event, words(this.data, this.samples, i));
    };
    view.figure.addEventListener("pointermove", point);
    view.figure.addEventListener("pointerdown", point);
    // A swipe moves the page, not the picture, whose buttons zoom: plotly.js would take every touch.
    view.figure.addEventListener("touchstart", (event) => event.stopPropagation(), { capture: true, passive: true });
    // A finger leaves when it is lifted; what it asked for stays until it asks elsewhere.
    view.figure.addEventListener("pointerleave", (event) => event.pointerType === "touch" || this.tip.hide());
    for (const name of ["plotly_afterplot", "plotly_relayouting"]) view.figure.on(name, () => view.draw(this.now));
    view.draw(this.now);
  }

  /** Show a sample in all pictures. */
  show(i) {
    this.now = i;
    this.views.forEach((view) => view.draw(i));
    this.slider.value = String(i);
  }

  buttons() {
    const bar = document.getElementById("colours");
    this.data.colourings.forEach((colouring, chosen) => {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = colouring.name;
      button.addEventListener("click", () => this.choose(chosen));
      bar.append(button);
    });
    if (this.data.colourings.length) this.mark(0);
  }

  choose(chosen) {
    this.mark(chosen);
    this.part.colour(chosen);
  }

  mark(chosen) {
    const buttons = document.getElementById("colours").querySelectorAll("button");
    buttons.forEach((button, i) => button.setAttribute("aria-pressed", String(i === chosen)));
    legend(document.getElementById("legend"), this.data.colourings[chosen]);
  }

  /** The slider, and the button that moves it as fast as the program runs, a long one faster. */
  clock() {
    const button = document.getElementById("play");
    this.slider.max = String(this.samples.count - 1);
    this.slider.addEventListener("input", () => this.show(Number(this.slider.value)));
    const duration = this.samples.time[this.samples.count - 1];
    const pace = Math.max(1, duration / LONGEST_PLAY);
    let running = false;
    const stop = () => {
      running = false;
      button.textContent = "Play";
    };
    button.addEventListener("click", () => {
      if (running) return stop();
      running = true;
      button.textContent = "Stop";
      const from = Number(this.slider.value) >= this.samples.count - 1 ? 0 : this.samples.time[this.slider.value];
      const start = performance.now();
      const step = (now) => {
        if (!running) return;
        const time = from + (pace * (now - start)) / 1000;
        this.show(this.samples.at(time));
        if (time >= duration) stop();
        else requestAnimationFrame(step);
      };
      return requestAnimationFrame(step);
    });
  }

  /** The buttons in the table of checks that go to a place. */
  places() {
    document.querySelectorAll("button[data-x]").forEach((button) => {
      button.addEventListener("click", () => {
        const { x, y, tick } = button.dataset;
        this.part.goTo([Number(x), Number(y)]);
        this.show(tick ? Math.floor(Number(tick) / this.samples.step) : this.now);
        this.part.figure.scrollIntoView({ block: "center" });
      });
    });
  }

  /** Paper is narrower than a screen, and what is printed is drawn for it. */
  printing() {
    const each = (size) => this.views.forEach(({ figure }) => Plotly.relayout(figure, size(figure)));
    const tall = (figure) => (figure.id === "workspace" ? 400 : figure.clientHeight);
    window.addEventListener("beforeprint", () => each((figure) => ({ width: PAPER, height: tall(figure) })));
    window.addEventListener("afterprint", () => each(() => ({ width: null, height: null, autosize: true })));
  }
}

/** The colours with their labels. */
function legend(box, { title, colors, labels, ramp }) {
  const heading = document.createElement("span");
  heading.textContent = title;
  const list = document.createElement("ul");
  list.className = ramp ? "ramp" : "";
  labels.forEach((label, i) => {
    if (!label) return;
    const item = document.createElement("li");
    const swatch = document.createElement("i");
    swatch.style.backgroundColor = colors[i];
    item.append(swatch, label);
    list.append(item);
  });
  box.replaceChildren(heading, list);
}

document.documentElement.classList.add("live");
new Page(JSON.parse(document.getElementById("data").textContent));
