// The page's own small tools: elements, numbers, tables, plots. Nothing here knows what a lens is.
"use strict";

/** Makes an element; strings become text, never markup. */
function make(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    node.setAttribute(name, value === true ? "" : value);
  }
  node.append(...children.filter((child) => child !== null && child !== undefined));
  return node;
}

const isNumber = (value) => typeof value === "number" && Number.isFinite(value);

/** A number with `digits` decimals and a true minus sign; a dash where there is none. */
function shown(value, digits = 2) {
  if (!isNumber(value)) return "–";
  const text = value.toFixed(digits);
  return (Number(text) === 0 ? (0).toFixed(digits) : text).replace("-", "−");
}

/** The same with a plus sign, as powers are written. */
function signed(value, digits = 2) {
  const text = shown(value, digits);
  return isNumber(value) && Number(value.toFixed(digits)) > 0 ? "+" + text : text;
}

function facts(entries) {
  const list = make("dl", {class: "facts"});
  for (const [name, value] of entries)
    if (value !== undefined && value !== null && value !== "")
      list.append(make("div", {}, make("dt", {}, name), make("dd", {}, String(value))));
  return list;
}

/** Pass, fail, or pass and fail that rest on a figure nobody has read in its source. */
function verdict(pass, unverified = false) {
  if (pass === null || pass === undefined) return make("span", {class: "quiet"}, "not judged");
  const word = pass ? "pass" : "fail";
  return make("span", {class: "verdict " + (unverified && pass ? "doubt" : word)}, unverified ? word + " (unverified figure)" : word);
}

/** columns: [{title, value(row), digits?, sign?}]; rows sort by a click on a title where `sortable`. */
function table(caption, columns, rows, sortable = false) {
  const body = make("tbody");
  const cell = (column, row) => {
    const value = column.value(row);
    if (value instanceof Node) return make("td", {}, value);
    if (isNumber(value)) return make("td", {class: "number"}, column.sign ? signed(value, column.digits) : shown(value, column.digits));
    return make("td", {class: column.digits === undefined ? null : "number"}, value === null || value === undefined ? "–" : String(value));
  };
  const fill = (ordered) => body.replaceChildren(...ordered.map((row) => make("tr", {}, ...columns.map((column) => cell(column, row)))));
  const head = make("tr");
  let sortedBy = null, descending = false;
  columns.forEach((column, index) => {
    const title = make("th", {scope: "col", class: column.digits === undefined ? null : "number"});
    if (sortable) {
      const button = make("button", {class: "sort", type: "button"}, column.title);
      button.addEventListener("click", () => {
        descending = sortedBy === index ? !descending : false;
        sortedBy = index;
        const by = (a, b) => {
          const x = column.value(a), y = column.value(b);
          if (isNumber(x) && isNumber(y)) return x - y;
          return String(x ?? "").localeCompare(String(y ?? ""));
        };
        fill([...rows].sort((a, b) => (descending ? -by(a, b) : by(a, b))));
      });
      title.append(button);
    } else {
      title.append(column.title);
    }
    head.append(title);
  });
  fill(rows);
  return make("div", {class: "table"},
              make("table", {}, caption ? make("caption", {}, caption) : null, make("thead", {}, head), body));
}

function details(title, ...children) {
  return make("details", {}, make("summary", {}, title), ...children);
}

const kFont = {family: "system-ui, DejaVu Sans, sans-serif", size: 12, color: "#1d2733"};
const pending = [];
let drawnCount = 0;

/** A figure with a caption and a plot that follows the window's width. Drawn once it is in the page. */
function figure(title, unit, traces, layout = {}, tall = false) {
  const place = make("div", {class: tall ? "plot tall" : "plot", role: "img", "aria-label": title});
  pending.push(() => Plotly.newPlot(place, traces, {
    font: kFont, margin: {l: 54, r: 12, t: 34, b: 44}, modebar: {bgcolor: "rgba(0,0,0,0)", color: "#9aa5b1", activecolor: "#1d2733"},
    paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "#ffffff",
    hovermode: "closest", legend: {orientation: "h", x: 0, y: 1, yanchor: "bottom"}, ...layout
  }, {responsive: true, displaylogo: false, modeBarButtonsToRemove: ["select2d", "lasso2d"]}));
  return make("figure", {class: "figure"},
              make("figcaption", {}, title + " ", unit ? make("span", {}, unit) : null), place);
}

/** What is round on a map: places in the plane, or directions, whose angles from straight ahead go by their tangents. */
const kPlaces = {to: (mm) => mm, from: (mm) => mm};
const kDirections = {to: (deg) => Math.tan(deg * Math.PI / 180), from: (tangent) => Math.atan(tangent) * 180 / Math.PI};

/**
 * The radius of the circle about (0, 0) that a grid's points fill, as `measure` has it: the grid reaches it to all four sides, all places
 * within the farthest point are there, and some beyond are not. Else null.
 */
function circleOf(grid, measure) {
  let radius = 0;
  const each = (use) => grid.cells.forEach((row, j) => row.forEach((cell, i) => use(cell, Math.hypot(measure.to(grid.x[i]), measure.to(grid.y[j])))));
  each((cell, r) => { if (cell) radius = Math.max(radius, r); });
  for (const values of [grid.x, grid.y]) {
    const step = measure.to(values[1] - values[0]);
    if (Math.min(-measure.to(values[0]), measure.to(values[values.length - 1])) < radius - 1.5 * step) return null;
  }
  each((cell, r) => { if (cell) radius = Math.max(radius, r); });
  let whole = true, beyond = false;
  each((cell, r) => {
    if (!cell && r < radius * (1 - 1e-6)) whole = false;
    if (!cell && r > radius) beyond = true;
  });
  return whole && beyond ? radius : null;
}

/** A value next to the points, continued from three, two or one of them in a row; the mean over all directions. */
function continued(values, j, i) {
  const at = (k, dj, di) => (values[j + k * dj] || [])[i + k * di];
  const found = [];
  for (const [dj, di] of [[0, 1], [0, -1], [1, 0], [-1, 0], [1, 1], [1, -1], [-1, 1], [-1, -1]]) {
    const [a, b, c] = [at(1, dj, di), at(2, dj, di), at(3, dj, di)];
    if (isNumber(a) && isNumber(b)) found.push(isNumber(c) ? 3 * a - 3 * b + c : 2 * a - b);
  }
  return found.length ? found.reduce((sum, v) => sum + v, 0) / found.length : null;
}

/**
 * Grid, values and texts of a map on a round domain, with up to two places more on each side: contours then run to the circle in place of from
 * point to point along its steps. What lies beyond the circle is covered (circleFrame); pointers find no text there.
 */
function roundedMap(grid, values, text) {
  const wider = (v) => [2 * v[0] - v[1], ...v, 2 * v[v.length - 1] - v[v.length - 2]];
  const pad = (rows, filler) => {
    const empty = () => new Array(grid.x.length + 2).fill(filler);
    return [empty(), ...rows.map((row) => [filler, ...row, filler]), empty()];
  };
  let filled = pad(values, null);
  for (let pass = 0; pass < 2; ++pass) {
    const before = filled;
    filled = before.map((row, j) => row.map((v, i) => (isNumber(v) ? v : continued(before, j, i))));
  }
  return {grid: {x: wider(grid.x), y: wider(grid.y)}, values: filled, text: pad(text, "")};
}

/** Covers what lies outside a circle about (0, 0), and draws it. */
function circleFrame(radius, measure) {
  const corner = 3 * measure.from(radius), steps = 180;
  const circle = Array.from({length: steps}, (_, k) => [Math.cos, Math.sin].map((f) => measure.from(radius * f(2 * Math.PI * k / steps))).join(","));
  return [{type: "path", path: `M-${corner},-${corner}L${corner},-${corner}L${corner},${corner}L-${corner},${corner}ZM${circle.join("L")}Z`,
           fillrule: "evenodd", fillcolor: "#ffffff", line: {color: "#33404d", width: 1}, layer: "above"}];
}

/**
 * A contour map of z over a grid of x and y (rows of z belong to y). `scale`: "about zero" (two colours that meet at 0),
 * "from zero", or "range" (from the least to the greatest value).
 */
function contourMap(title, unit, grid, values, text, axes, scale) {
  const flat = values.flat().filter(isNumber);
  const least = flat.reduce((a, b) => Math.min(a, b)), greatest = flat.reduce((a, b) => Math.max(a, b));
  const most = Math.max(1e-3, -least, greatest);  // a map of nothing but rounding shows one colour
  const range = {
    "about zero": {zmin: -most, zmax: most, colorscale: "RdBu"},
    "from zero": {zmin: 0, zmax: most, colorscale: "Viridis"},
    // What differs by less than half a thousandth is one colour: the rest is how well a spline fits.
    "range": {zmin: least, zmax: Math.max(greatest, least + 1e-3, least + 5e-4 * Math.abs(greatest)), colorscale: "Cividis"}
  }[scale];
  const measure = axes.measure || kPlaces, radius = circleOf(grid, measure), reach = 1.04 * measure.from(radius || 0);
  const map = radius ? roundedMap(grid, values, text) : {grid, values, text};
  const round = radius ? {range: [-reach, reach]} : {};
  return figure(title, unit, [{
    type: "contour", x: map.grid.x, y: map.grid.y, z: map.values, text: map.text, hovertemplate: "%{text}<extra></extra>",
    contours: {coloring: "heatmap", showlabels: true, labelfont: {size: 11}}, line: {width: 0.7, color: "#33404d"},
    connectgaps: false, colorbar: {thickness: 12, outlinewidth: 0}, ncontours: 12, ...range
  }], {xaxis: {title: {text: axes.x}, zeroline: false, constrain: "domain", ...round},
       yaxis: {title: {text: axes.y}, zeroline: false, scaleanchor: "x", constrain: "domain", ...round},
       shapes: radius ? circleFrame(radius, measure) : []});
}

/** Draws what has been put into the page since the last call; data-ready on the page counts the plots drawn so far. */
async function drawAll() {
  const now = pending.splice(0);
  await Promise.all(now.map((draw) => draw()));
  drawnCount += now.length;
  document.documentElement.dataset.ready = String(drawnCount);
}
