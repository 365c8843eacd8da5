/* What moves over a picture: the place of the tool, a line at a time, the arms, a mark, and the words beside the pointer. */

const SVG = "http://www.w3.org/2000/svg";

/** A layer over a figure of plotly.js, in the coordinates of its axes. */
class Overlay {
  constructor(figure) {
    this.figure = figure;
    this.layer = document.createElementNS(SVG, "svg");
    this.layer.setAttribute("class", "over");
    this.layer.setAttribute("aria-hidden", "true");
    this.shapes = {};
    figure.append(this.layer);
  }

  get axes() {
    return this.figure._fullLayout;
  }

  /** The pixel of a place. */
  pixel(x, y) {
    const { xaxis, yaxis } = this.axes;
    return [xaxis._offset + xaxis.d2p(x), yaxis._offset + yaxis.d2p(y)];
  }

  /** The place under the pointer, or null beside the axes. */
  under(event) {
    const { xaxis, _size: size } = this.axes;
    const box = this.figure.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left - size.l, event.clientY - box.top - size.t];
    if (x < 0 || y < 0 || x > size.w || y > size.h) return null;
    const place = { x: xaxis.p2d(x), perPixel: Math.abs(xaxis.p2d(1) - xaxis.p2d(0)) };
    return { ...place, y: this.axes.yaxis.p2d(event.clientY - box.top - this.axes.yaxis._offset) };
  }

  /** A shape of the layer, made where it is missing; without attributes it is hidden. */
  draw(name, kind, attributes) {
    const shape = (this.shapes[name] ??= this.layer.appendChild(document.createElementNS(SVG, kind)));
    shape.setAttribute("class", name);
    shape.style.display = attributes ? "" : "none";
    for (const [key, value] of Object.entries(attributes ?? {})) shape.setAttribute(key, value);
  }

  /** A dot at a place, hidden beside the axes. */
  dot(name, place, radius) {
    const { _size: size } = this.axes;
    const [cx, cy] = place ? this.pixel(...place) : [-1, -1];
    const inside = cx >= size.l && cy >= size.t && cx <= size.l + size.w && cy <= size.t + size.h;
    this.draw(name, "circle", inside ? { cx, cy, r: radius } : null);
  }

  /** A line from the top to the bottom of all rows. */
  upright(name, x) {
    const { xaxis, _size: size } = this.axes;
    const at = xaxis.d2p(x);
    const inside = at >= 0 && at <= xaxis._length;
    const [left, top, bottom] = [xaxis._offset + at, size.t, size.t + size.h];
    this.draw(name, "path", inside ? { d: `M${left} ${top}V${bottom}` } : null);
  }
}

/** Words beside the pointer. */
class Tip {
  constructor() {
    this.box = document.createElement("div");
    this.box.className = "tip";
    this.box.setAttribute("role", "status");
    this.box.hidden = true;
    document.body.append(this.box);
  }

  show(event, rows) {
    this.box.replaceChildren(
      ...rows.map(([name, value]) => {
        const row = document.createElement("div");
        const label = document.createElement("span");
        const text = document.createElement("b");
        label.textContent = name;
        text.textContent = value;
        row.append(label, text);
        return row;
      }),
    );
    this.box.hidden = false;
    const { width, height } = this.box.getBoundingClientRect();
    const right = event.clientX + 16 + width > window.innerWidth;
    const below = event.clientY + 16 + height > window.innerHeight;
    const left = right ? event.clientX - 16 - width : event.clientX + 16;
    this.box.style.left = `${Math.max(left, 4) + window.scrollX}px`;
    this.box.style.top = `${Math.max(below ? event.clientY - 16 - height : event.clientY + 16, 4) + window.scrollY}px`;
  }

  hide() {
    this.box.hidden = true;
  }
}
