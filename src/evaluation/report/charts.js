// Figures as inline SVG.
function element(tag, attributes = {}, ...children) {
  const svg = ["svg", "g", "path", "rect", "line", "text", "title", "circle"].includes(tag);
  const node = svg ? document.createElementNS("http://www.w3.org/2000/svg", tag) : document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...children);
  return node;
}

// Round steps that cut the range into about `wanted` parts.
function ticks(low, high, wanted) {
  const rough = (high - low) / wanted, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map(m => m * power).find(s => s >= rough);
  const places = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const all = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + step * 1e-9; ++i) all.push((i * step).toFixed(places));
  return all;
}

const SERIES_COLOURS = {real: "var(--truth)"};

function histogramFigure(figure) {
  const W = 460, H = 230, left = 42, right = 8, top = 10, bottom = 34;
  const most = Math.max(1, ...figure.series.flatMap(s => s.counts));
  const fitted = Math.max(0, ...figure.series.flatMap(s => s.curves.slice(0, 1).flatMap(c => c.points)).filter(p => p !== null));
  const highest = Math.min(Math.max(most, fitted), 1.5 * most) * 1.06;
  const x = v => left + (v - figure.low) / (figure.high - figure.low) * (W - left - right);
  const y = v => H - bottom - Math.min(v, highest) / highest * (H - top - bottom);
  const svg = element("svg", {viewBox: `0 0 ${W} ${H}`, role: "img"});
  svg.append(element("title", {}, `${figure.title}, ${figure.action}`));
  for (const t of ticks(0, highest, 4)) {
    svg.append(element("line", {class: "axis", x1: left, x2: W - right, y1: y(t), y2: y(t)}),
               element("text", {x: left - 6, y: y(t) + 4, "text-anchor": "end"}, t));
  }
  for (const t of ticks(figure.low, figure.high, 5))
    svg.append(element("text", {x: x(t), y: H - bottom + 16, "text-anchor": "middle"}, t));
  svg.append(element("text", {x: (left + W - right) / 2, y: H - 3, "text-anchor": "middle"}, "PCC"));
  const keys = element("div", {class: "keys-of-chart"});
  for (const series of figure.series) {
    const colour = SERIES_COLOURS[series.label] ?? "var(--other)";
    const width = (figure.high - figure.low) / series.counts.length;
    series.counts.forEach((count, bin) => {
      if (count === 0) return;
      const from = x(figure.low + bin * width) + .5, to = x(figure.low + (bin + 1) * width) - .5;
      svg.append(element("rect", {x: from, y: y(count), width: Math.max(1, to - from), height: y(0) - y(count),
                                  rx: 2, fill: colour, "fill-opacity": figure.series.length > 1 ? .38 : .5},
                         element("title", {}, `${count} of ${series.count}`)));
    });
    keys.append(element("span", {}, element("i", {class: "block", style: `background:${colour}`}),
                        `${series.label}, ${series.count}`));
  }
  for (const series of figure.series) {
    series.curves.forEach((curve, rank) => {
      const colour = figure.series.length > 1 ? SERIES_COLOURS[series.label] ?? "var(--other)" : `var(--curve-${rank})`;
      const step = (figure.high - figure.low) / (curve.points.length - 1);
      let path = "";
      curve.points.forEach((p, i) => {
        if (p === null) return;
        path += `${path ? "L" : "M"}${x(figure.low + i * step).toFixed(1)} ${y(p).toFixed(1)}`;
      });
      svg.append(element("path", {d: path, fill: "none", stroke: colour, "stroke-width": rank === 0 ? 2.4 : 1.3,
                                  "stroke-dasharray": rank === 0 ? "" : "5 3", class: "curve"}));
      const behind = rank === 0 ? "" : ` (AIC +${(curve.aic - series.curves[0].aic).toFixed(1)})`;
      const whose = figure.series.length > 1 ? ` of ${series.label}` : "";
      keys.append(element("span", {}, element("i", {style: `background:${colour}`}), `${curve.family}${whose}${behind}`));
    });
  }
  return element("figure", {class: "panel"}, element("h4", {}, figure.title),
                 element("span", {class: "quiet"}, figure.paper), svg, keys);
}

function barChart(title, bars, digits) {
  const box = element("div", {class: "bars"}, element("h4", {}, title));
  const largest = Math.max(...bars.map(bar => Math.abs(bar.value)));
  for (const bar of bars) {
    const share = Math.max(0, bar.value) / (largest || 1) * 100;
    box.append(element("div", {class: bar.model ? "bar model" : "bar"}, element("span", {title: bar.label}, bar.label),
                       element("i", {}, element("i", {style: `width:${share}%`})),
                       element("span", {}, bar.value.toFixed(digits))));
  }
  return box;
}
