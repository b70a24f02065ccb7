// A batch: how it went, a plot of any quantity against any other, and every case in a table that sorts.
"use strict";

/** Columns are {name, title, numeric}; rows are arrays in their order. */
function batchPlot(batch) {
  const numeric = batch.columns.filter((c) => c.numeric);
  if (numeric.length < 2) return null;
  const choose = (label, chosen) => {
    const select = make("select", {"aria-label": label}, ...numeric.map((c) => make("option", {value: c.name, selected: c.name === chosen}, c.title)));
    return {select, label: make("label", {}, label + " ", select)};
  };
  const known = (name, other) => (numeric.some((c) => c.name === name) ? name : numeric[other].name);
  const x = choose("Across", known(batch.plot_x, 0)), y = choose("Up", known(batch.plot_y, 1));
  const index = (name) => batch.columns.findIndex((c) => c.name === name);
  const done = batch.rows.filter((row) => row[index("status")] === "done");
  const data = () => {
    const i = index(x.select.value), j = index(y.select.value), key = index("case");
    const rows = done.filter((row) => isNumber(row[i]) && isNumber(row[j]));
    return {x: rows.map((row) => row[i]), y: rows.map((row) => row[j]), text: rows.map((row) => `case ${row[key]}`)};
  };
  const titles = () => ({"xaxis.title.text": batch.columns[index(x.select.value)].title, "yaxis.title.text": batch.columns[index(y.select.value)].title});
  const node = figure("One quantity against another", "a mark is a case", [{
    type: "scatter", mode: "markers", ...data(), marker: {size: 6, opacity: 0.7, color: "#1f5fbf"},
    hovertemplate: "%{text}<br>%{x} · %{y}<extra></extra>"
  }], {xaxis: {title: {text: titles()["xaxis.title.text"]}}, yaxis: {title: {text: titles()["yaxis.title.text"]}}});
  const again = () => {
    const d = data();
    Plotly.update(node.querySelector(".plot"), {x: [d.x], y: [d.y], text: [d.text]}, titles());
  };
  x.select.addEventListener("change", again);
  y.select.addEventListener("change", again);
  return make("div", {}, make("p", {}, x.label, y.label), make("div", {class: "plots"}, node, batchHistogram(batch, done)));
}

function batchHistogram(batch, done) {
  const column = batch.columns.findIndex((c) => c.name === batch.plot_y);
  if (column < 0) return null;
  const values = done.map((row) => row[column]).filter(isNumber);
  return figure("How often", batch.columns[column].title, [{type: "histogram", x: values, marker: {color: "#5b87c7"}, hovertemplate: "%{x}: %{y} cases<extra></extra>"}],
                {xaxis: {title: {text: batch.columns[column].title}, ticks: "outside"}, yaxis: {title: {text: "cases"}, ticks: "outside"}, bargap: 0.05});
}

/** Maps of one lens at a time. */
function batchLens(batch) {
  const lenses = (batch.lenses || []).filter((lens) => lens.points.length > 0);
  if (!lenses.length) return null;
  const place = make("div");
  const select = make("select", {"aria-label": "Case"}, ...lenses.map((lens, i) =>
    make("option", {value: i}, `${lens.lens}: ${prescription(lens.reference)}, ${lens.mode}`)));
  const show = () => place.replaceChildren(lensSection(lenses[Number(select.value)]));
  select.addEventListener("change", () => { show(); drawAll(); });
  show();
  return make("div", {}, make("h3", {}, "One lens"), make("p", {}, make("label", {}, "Show ", select)), place);
}

function batchSection(batch) {
  const section = make("section", {}, make("h2", {}, "Batch"));
  const c = batch.counts;
  section.append(facts([["Cases", c.done + c.failed + c.pending], ["Done", c.done], ["Failed", c.failed], ["Pending", c.pending]]));
  if (batch.failures.length)
    section.append(make("h3", {}, "Failures"), table("", [
      {title: "Cases", value: (f) => f.count, digits: 0}, {title: "Reason (the first of them)", value: (f) => f.example}], batch.failures));
  section.append(batchPlot(batch) || "", batchLens(batch) || "");
  const columns = batch.columns.map((column, i) => ({title: column.title, value: (row) => row[i], digits: column.numeric ? column.digits : undefined}));
  const rows = table("", columns, batch.rows, true);
  section.append(make("h3", {}, "Cases"));
  if (batch.rows.length < c.done + c.failed + c.pending)
    section.append(make("p", {class: "quiet"}, `The first ${batch.rows.length} cases are listed; the export has all of them.`));
  section.append(batch.rows.length > 200 ? details(`All ${batch.rows.length} rows`, rows) : rows);
  return section;
}
