// One lens: what it is, maps over the gaze or over the lens, profiles, verdicts, and the numbers themselves.
"use strict";

function prescription(r) {
  if (!r || !isNumber(r.sphere_d)) return "–";
  const cylinder = Math.abs(r.cylinder_d) < 0.005 ? "" : ` / ${signed(r.cylinder_d)} × ${shown(r.axis_deg, 0)}°`;
  return signed(r.sphere_d) + cylinder;
}

/** Points as a grid, where they are one: distinct abscissae and ordinates, and a matrix of points (null: none). */
function gridOf(points, x, y) {
  const distinct = (of) => [...new Set(points.map((p) => Math.round(of(p) * 1e6) / 1e6))].sort((a, b) => a - b);
  const xs = distinct(x), ys = distinct(y);
  if (xs.length < 3 || ys.length < 3 || xs.length * ys.length > 4 * points.length + 16) return null;
  const cells = ys.map(() => xs.map(() => null));
  const at = (values, v) => values.indexOf(Math.round(v * 1e6) / 1e6);
  for (const p of points) cells[at(ys, y(p))][at(xs, x(p))] = p;
  return {x: xs, y: ys, cells};
}

const prismOf = (p) => Math.hypot(p.prism_h, p.prism_v);
const meanOf = (p) => p.sphere_d + p.cylinder_d / 2;

const kLensMaps = [
  {title: "Mean power", unit: "D", value: meanOf, scale: "range"},
  {title: "Mean power error", unit: "D, against the reference point", value: (p) => p.mean_power_error_d, scale: "about zero"},
  {title: "Oblique astigmatism", unit: "D", value: (p) => Math.abs(p.oblique_astigmatism_d), scale: "from zero"},
  {title: "Prism", unit: "Δ", value: prismOf, scale: "from zero"},
  {title: "Distortion", unit: "%", value: (p) => (isNumber(p.distortion) ? 100 * p.distortion : NaN), scale: "about zero"},
  {title: "Transverse colour", unit: "Δ between F and C", value: (p) => Math.abs(p.tca_d), scale: "from zero"}
];

function lensHover(p, map) {
  const lines = [`${map.title}: <b>${signed(map.value(p), 3)}</b> ${map.unit.split(",")[0]}`,
                 `gaze ${signed(p.gaze_h_deg, 1)}°, ${signed(p.gaze_v_deg, 1)}° · point ${signed(p.x_mm, 1)}, ${signed(p.y_mm, 1)} mm`,
                 prescription(p), `prism ${signed(p.prism_h)} Δ right, ${signed(p.prism_v)} Δ up`];
  return lines.join("<br>");
}

const gazeGrid = (points) => gridOf(points, (p) => p.gaze_h_deg, (p) => p.gaze_v_deg);
const placeGrid = (points) => gridOf(points, (p) => p.x_mm, (p) => p.y_mm);

function lensMaps(points, byGaze) {
  const grid = byGaze ? gazeGrid(points) : placeGrid(points);
  if (!grid) return null;
  const axes = byGaze ? {x: "gaze to the right, seen from before the wearer, °", y: "gaze up, °", measure: kDirections} : {x: "to the right, seen from before the wearer, mm", y: "up, mm"};
  const plots = make("div", {class: "plots"});
  for (const map of kLensMaps) {
    const values = grid.cells.map((row) => row.map((p) => (p ? map.value(p) : NaN)));
    // What is nowhere (distortion by a focimeter, colour without dispersion) needs no map.
    if (!values.flat().some((v) => isNumber(v) && Math.abs(v) > 1e-9)) continue;
    const clean = values.map((row) => row.map((v) => (isNumber(v) ? v : null)));
    const text = grid.cells.map((row) => row.map((p) => (p ? lensHover(p, map) : "")));
    plots.append(contourMap(map.title, map.unit, grid, clean, text, axes, map.scale));
  }
  return plots;
}

/** Power along the meridian at `angle_deg` from the horizontal: S + C sin^2 of the angle to the axis. */
function powerAlong(p, angle_deg) {
  const sine = Math.sin((angle_deg - p.axis_deg) * Math.PI / 180);
  return p.sphere_d + p.cylinder_d * sine * sine;
}

/** Tangential and sagittal power along a line of points through the middle; there along and across the line. */
function lensProfile(points, byGaze) {
  const plots = make("div", {class: "plots"});
  const lines = [["horizontal", 0, byGaze ? (p) => p.gaze_v_deg : (p) => p.y_mm, byGaze ? (p) => p.gaze_h_deg : (p) => p.x_mm],
                 ["vertical", 90, byGaze ? (p) => p.gaze_h_deg : (p) => p.x_mm, byGaze ? (p) => p.gaze_v_deg : (p) => p.y_mm]];
  for (const [name, angle_deg, across, along] of lines) {
    const line = points.filter((p) => Math.abs(across(p)) < 1e-6).sort((a, b) => along(a) - along(b));
    if (line.length < 3) continue;
    const middle = (p) => Math.abs(along(p)) < 1e-6;
    const trace = (label, value, dash) => ({type: "scatter", mode: "lines+markers", name: label, line: {dash}, marker: {size: 4},
                                            x: line.map(along), y: line.map(value),
                                            hovertemplate: `${label} %{y:.3f} D at %{x:.1f}<extra></extra>`});
    plots.append(figure(`Power along the ${name} line`, "D",
                        [trace("tangential", (p) => (middle(p) ? powerAlong(p, angle_deg) : p.tangential_d), "solid"),
                         trace("sagittal", (p) => (middle(p) ? powerAlong(p, angle_deg + 90) : p.sagittal_d), "dash"),
                         trace("mean", meanOf, "dot")],
                        {xaxis: {title: {text: byGaze ? "gaze, °" : "mm"}}, yaxis: {title: {text: "D"}}}));
  }
  return plots.childElementCount ? plots : null;
}

function limitsTable(lens) {
  if (!lens.limits || !lens.limits.length) return null;
  const rule = lens.rule || {};
  const title = make("h3", {}, `Limits: ${rule.title || ""} `, verdict(rule.pass, rule.certainty === "unverified"));
  return make("div", {}, title, make("p", {class: "quiet"}, [rule.edition, rule.lens_type, rule.note].filter(Boolean).join(" · ")), table("", [
    {title: "Clause", value: (l) => l.clause}, {title: "Requirement", value: (l) => l.requirement},
    {title: "Ordered", value: (l) => l.ordered, digits: 3, sign: true}, {title: "Measured", value: (l) => l.value, digits: 3, sign: true},
    {title: "Deviation", value: (l) => l.deviation, digits: 3, sign: true}, {title: "Limit", value: (l) => l.limit, digits: 3},
    {title: "Unit", value: (l) => l.unit}, {title: "Verdict", value: (l) => verdict(l.pass, l.certainty === "unverified")},
    {title: "Certainty of the figure", value: (l) => l.certainty}
  ], lens.limits), ...(lens.limits_not_judged || []).map((n) => make("p", {class: "quiet"}, `Not judged: ${n.quantity}: ${n.reason}`)));
}

function lensSection(lens) {
  const section = make("section", {}, make("h2", {}, lens.lens));
  const r = lens.reference || {};
  const points = (lens.points || []).filter((p) => isNumber(p.sphere_d));
  const blocked = (lens.points || []).length - points.length;
  section.append(facts([
    ["Measured", `${lens.mode}, ${shown(lens.wavelength_nm, 2)} nm`], ["Material", lens.material],
    ["At the reference point", prescription(r)],
    ["Prism there", isNumber(r.prism_d) && r.prism_d >= 0.005 ? `${shown(r.prism_d)} Δ base ${shown(r.prism_base_deg, 0)}°` : "none"],
    ["Spectacle magnification", isNumber(lens.spectacle_magnification) ? shown(lens.spectacle_magnification, 4) : null],
    ["Points", blocked ? `${points.length}; ${blocked} more let no ray through` : `${points.length}`]
  ]));
  if (lens.picture)
    section.append(make("figure", {class: "picture"}, make("img", {src: lens.picture, alt: `A square grid seen through ${lens.lens}`}),
                        make("figcaption", {}, "What the wearer sees: a wall 2 m away with a square grid (5° straight ahead), the red lines through the middle. " +
                                               "The wearer looks out, so this is the other way round than the maps.")));
  section.append(limitsTable(lens) || "");
  const byGaze = Boolean(gazeGrid(points) || !placeGrid(points));
  section.append(lensMaps(points, byGaze) || "", lensProfile(points, byGaze) || "");
  section.append(details(`All ${points.length} points`, table("", [
    {title: "Gaze h, °", value: (p) => p.gaze_h_deg, digits: 1, sign: true}, {title: "v, °", value: (p) => p.gaze_v_deg, digits: 1, sign: true},
    {title: "x, mm", value: (p) => p.x_mm, digits: 2, sign: true}, {title: "y, mm", value: (p) => p.y_mm, digits: 2, sign: true},
    {title: "Sphere, D", value: (p) => p.sphere_d, digits: 3, sign: true}, {title: "Cylinder, D", value: (p) => p.cylinder_d, digits: 3, sign: true},
    {title: "Axis, °", value: (p) => p.axis_deg, digits: 1}, {title: "Tangential, D", value: (p) => p.tangential_d, digits: 3, sign: true},
    {title: "Sagittal, D", value: (p) => p.sagittal_d, digits: 3, sign: true},
    {title: "Mean error, D", value: (p) => p.mean_power_error_d, digits: 3, sign: true},
    {title: "Astigmatism, D", value: (p) => p.oblique_astigmatism_d, digits: 3, sign: true},
    {title: "Prism h, Δ", value: (p) => p.prism_h, digits: 3, sign: true}, {title: "v, Δ", value: (p) => p.prism_v, digits: 3, sign: true},
    {title: "Colour, Δ", value: (p) => p.tca_d, digits: 3}
  ], points, true)));
  return section;
}
