// Values under the pointer, and zoom, in the figures of a report. All data are in the page; nothing is loaded.
"use strict";
const NAMESPACE = "http://www.w3.org/2000/svg";
const NEAR = 30; // px of the figure: farther points are not meant

const place = (axis, value) =>
  axis.spacing === "logarithmic" ? Math.log(value / axis.range[0]) / Math.log(axis.range[1] / axis.range[0])
                                 : (value - axis.range[0]) / (axis.range[1] - axis.range[0]);
const valueAt = (axis, part) =>
  axis.spacing === "logarithmic" ? axis.range[0] * Math.pow(axis.range[1] / axis.range[0], part)
                                 : axis.range[0] + part * (axis.range[1] - axis.range[0]);
const shown = value => Number(value.toPrecision(6)).toString().replace("e+", "e").replace(/-/g, "−");

const raised = power => [...String(power)].map(it => "⁰¹²³⁴⁵⁶⁷⁸⁹"[it] ?? "⁻").join("");

// Marks of an axis between two values; at most about `most` of them.
function marks(axis, low, high, most) {
  const found = [];
  if (axis.spacing === "logarithmic" && high / low > 8) {
    const from = Math.ceil(Math.log10(low) - 1e-9), to = Math.floor(Math.log10(high) + 1e-9);
    const every = Math.max(1, Math.ceil((to - from + 1) / most));
    for (let power = from; power <= to; power++) if (power % every === 0) found.push([Math.pow(10, power), "10" + raised(power)]);
    return found;
  }
  const least = (high - low) / most, power = Math.pow(10, Math.floor(Math.log10(least)));
  const step = [1, 2, 5, 10].map(it => it * power).find(it => it >= 0.999 * least);
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) found.push([i * step, shown(i * step)]);
  return found;
}

function symbol(shape, r, x, y) {
  switch (shape) {
    case "square": return `M${x - r} ${y - r}h${2 * r}v${2 * r}h${-2 * r}Z`;
    case "diamond": return `M${x - 1.3 * r} ${y}l${1.3 * r} ${-1.3 * r}l${1.3 * r} ${1.3 * r}l${-1.3 * r} ${1.3 * r}Z`;
    case "triangle": return `M${x - r} ${y + r}h${2 * r}l${-r} ${-2 * r}Z`;
    case "cross": return `M${x - r} ${y - r}l${2 * r} ${2 * r}m0 ${-2 * r}l${-2 * r} ${2 * r}`;
    default: return `M${x - r} ${y}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0Z`;
  }
}

class Panel {
  constructor(group, data) {
    this.group = group;
    this.data = data;
    this.frame = data.frame;
    this.paths = [...group.querySelectorAll("[data-series]")];
    this.axes = group.querySelector(".ticks");
    this.grid = group.querySelector(".grid");
    this.labels = [...group.querySelectorAll(".labels > g")];
    this.original = { axes: this.axes.innerHTML, grid: this.grid.getAttribute("d"), paths: this.paths.map(it => it.getAttribute("d")) };
    this.view = { x: [0, 1], y: [0, 1] };
  }

  holds(x, y) {
    const { left, top, width, height } = this.frame;
    return x >= left && x <= left + width && y >= top && y <= top + height;
  }

  // Where a value is drawn now, px.
  x(value) {
    const [low, high] = this.view.x;
    return this.frame.left + this.frame.width * (place(this.data.x, value) - low) / (high - low);
  }
  y(value) {
    const [low, high] = this.view.y;
    return this.frame.top + this.frame.height * (1 - (place(this.data.y, value) - low) / (high - low));
  }

  nearest(x, y) {
    let best = null, least = NEAR * NEAR;
    for (const series of this.data.series) {
      if (!series.name || series.style === "region") continue;
      for (const point of series.points) {
        if (point[0] === null || point[1] === null) continue;
        const at = [this.x(point[0]), this.y(point[1])];
        const distance = (at[0] - x) ** 2 + (at[1] - y) ** 2;
        if (distance < least && this.holds(at[0], at[1])) { least = distance; best = { series, point, at }; }
      }
    }
    return best;
  }

  // Shows the part between two corners, px.
  zoom(x0, y0, x1, y1) {
    const part = (low, high, from, length, a, b) => {
      const at = px => low + (high - low) * (px - from) / length;
      return [at(Math.min(a, b)), at(Math.max(a, b))];
    };
    const { left, top, width, height } = this.frame;
    const [low, high] = this.view.y;
    const x = part(...this.view.x, left, width, x0, x1);
    const y = part(high, low, top, height, y0, y1).reverse();
    if (x[1] - x[0] < 1e-6 || y[1] - y[0] < 1e-6 || x[1] - x[0] > 50 || y[1] - y[0] > 50) return;
    this.view = { x, y };
    this.redraw();
  }

  reset() {
    this.view = { x: [0, 1], y: [0, 1] };
    this.axes.innerHTML = this.original.axes;
    this.grid.setAttribute("d", this.original.grid);
    this.paths.forEach((path, i) => path.setAttribute("d", this.original.paths[i]));
    this.labels.forEach(label => label.removeAttribute("transform"));
  }

  redraw() {
    for (const path of this.paths) {
      const series = this.data.series[path.dataset.series];
      let d = "", open = false;
      for (const [vx, vy] of series.points) {
        const x = vx === null ? NaN : this.x(vx), y = vy === null ? NaN : this.y(vy);
        if (!isFinite(x) || !isFinite(y) || Math.abs(x) > 1e6 || Math.abs(y) > 1e6) { if (open && series.style === "region") d += "Z"; open = false; continue; }
        if (series.style === "points") { d += symbol(series.shape, series.radius, x, y); continue; }
        d += (open ? "L" : "M") + x.toFixed(2) + " " + y.toFixed(2);
        open = true;
      }
      path.setAttribute("d", d + (open && series.style === "region" ? "Z" : ""));
    }
    for (const label of this.labels) {
      const x = (+label.dataset.x - this.frame.left) / this.frame.width, y = 1 - (+label.dataset.y - this.frame.top) / this.frame.height;
      const dx = this.x(valueAt(this.data.x, x)) - label.dataset.x, dy = this.y(valueAt(this.data.y, y)) - label.dataset.y;
      label.setAttribute("transform", `translate(${dx} ${dy})`);
    }
    this.redrawAxes();
  }

  redrawAxes() {
    const { left, top, width, height } = this.frame;
    this.axes.innerHTML = "";
    let lines = "", grid = "";
    const text = (label, x, y, anchor) => {
      const made = document.createElementNS(NAMESPACE, "text");
      made.textContent = label;
      for (const [name, value] of Object.entries({ x, y, "text-anchor": anchor, "font-size": 11, "font-family": "DejaVu Sans, Verdana, sans-serif" })) made.setAttribute(name, value);
      this.axes.append(made);
    };
    if (this.data.x.ticked) for (const [value, label] of marks(this.data.x, ...this.view.x.map(it => valueAt(this.data.x, it)), width / 60)) {
      const x = this.x(value);
      lines += `M${x} ${top + height}v5`; grid += `M${x} ${top}v${height}`;
      text(label, x, top + height + 17, "middle");
    }
    if (this.data.y.ticked) for (const [value, label] of marks(this.data.y, ...this.view.y.map(it => valueAt(this.data.y, it)), height / 40)) {
      const y = this.y(value);
      lines += `M${left} ${y}h-5`; grid += `M${left} ${y}h${width}`;
      text(label, left - 9, y + 4, "end");
    }
    const path = document.createElementNS(NAMESPACE, "path");
    path.setAttribute("d", lines);
    path.setAttribute("stroke", "#000");
    path.setAttribute("stroke-width", "0.8");
    this.axes.append(path);
    this.grid.setAttribute("d", grid);
  }
}

function prepare(figure) {
  const svg = figure.querySelector("svg"), value = figure.querySelector(".value");
  const data = JSON.parse(figure.querySelector("script").textContent);
  const panels = [...svg.querySelectorAll(".panel")].map((group, i) => new Panel(group, data[i]));
  const overlay = document.createElementNS(NAMESPACE, "g");
  overlay.innerHTML = '<circle r="4.5" fill="none" stroke="#c00" stroke-width="1.5" visibility="hidden"/>' +
    '<rect fill="#0072b2" fill-opacity="0.12" stroke="#0072b2" visibility="hidden"/>';
  svg.append(overlay);
  const [ring, box] = overlay.children;
  let drag = null;
  const at = event => {
    const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    return [point.x, point.y];
  };
  const under = ([x, y]) => panels.find(panel => panel.holds(x, y));
  const hide = () => { value.style.display = "none"; ring.setAttribute("visibility", "hidden"); };
  const point = event => {
    const here = at(event), panel = under(here), found = panel && panel.nearest(...here);
    if (!found) return hide();
    ring.setAttribute("cx", found.at[0]); ring.setAttribute("cy", found.at[1]); ring.setAttribute("visibility", "visible");
    const line = (axis, v) => `${axis.name}: ${shown(v)}${axis.unit ? " " + axis.unit : ""}`;
    value.innerHTML = `<b>${found.series.name}</b><br>${line(panel.data.x, found.point[0])}<br>${line(panel.data.y, found.point[1])}`;
    value.style.display = "block";
    const inside = figure.getBoundingClientRect(), right = event.clientX - inside.left + 14;
    value.style.left = Math.min(right, figure.clientWidth - value.offsetWidth - 4) + "px";
    value.style.top = event.clientY - inside.top + 16 + "px";
  };
  const reset = () => { panels.forEach(panel => panel.reset()); figure.classList.remove("zoomed"); hide(); };
  svg.addEventListener("pointermove", event => {
    if (!drag) return point(event);
    const [x, y] = at(event), { left, top, width, height } = drag.panel.frame;
    drag.to = [Math.min(Math.max(x, left), left + width), Math.min(Math.max(y, top), top + height)];
    box.setAttribute("x", Math.min(drag.from[0], drag.to[0])); box.setAttribute("y", Math.min(drag.from[1], drag.to[1]));
    box.setAttribute("width", Math.abs(drag.to[0] - drag.from[0])); box.setAttribute("height", Math.abs(drag.to[1] - drag.from[1]));
    box.setAttribute("visibility", "visible");
  });
  svg.addEventListener("pointerleave", hide);
  svg.addEventListener("pointerdown", event => {
    const from = at(event), panel = under(from);
    if (panel && event.button === 0 && event.pointerType !== "touch") { drag = { panel, from, to: from }; hide(); }
  });
  window.addEventListener("pointerup", () => {
    if (!drag) return;
    const { panel, from, to } = drag;
    drag = null;
    box.setAttribute("visibility", "hidden");
    if (Math.abs(from[0] - to[0]) < 4 || Math.abs(from[1] - to[1]) < 4) return;
    panel.zoom(...from, ...to);
    figure.classList.add("zoomed");
  });
  svg.addEventListener("wheel", event => {
    const [x, y] = at(event), panel = under([x, y]);
    // A wheel over a figure scrolls the page unless a key says that the figure is meant, or it is zoomed already.
    if (!panel || !(event.ctrlKey || event.shiftKey || event.altKey || figure.classList.contains("zoomed"))) return;
    event.preventDefault();
    const factor = (event.deltaY || event.deltaX) > 0 ? 1.25 : 0.8, { left, top, width, height } = panel.frame;
    panel.zoom(x - factor * (x - left), y - factor * (y - top), x + factor * (left + width - x), y + factor * (top + height - y));
    figure.classList.add("zoomed");
    point(event);
  }, { passive: false });
  svg.addEventListener("dblclick", reset);
  figure.querySelector(".reset").addEventListener("click", reset);
}

document.querySelectorAll("figure").forEach(prepare);
