// One mirror: verdicts, the plan of what is seen of the road, and maps over the glass.
"use strict";

/** Corners as a closed line, mm on the ground to metres: behind the eyes downwards, left to the left. */
function groundLine(corners) {
  const closed = corners.length ? [...corners, corners[0]] : [];
  return {x: closed.map((c) => -c[1] / 1000), y: closed.map((c) => -c[0] / 1000)};
}

function fieldPlan(mirror) {
  const field = mirror.field || {}, vehicle = mirror.vehicle || {}, blind = mirror.blind_zone || {};
  const traces = [];
  const area = (name, corners, color, fill, dash) => {
    if (!corners || corners.length < 3) return;
    traces.push({type: "scatter", mode: "lines", name, ...groundLine(corners), fill: fill ? "toself" : "none", fillcolor: fill || undefined,
                 line: {color, width: 1.6, dash: dash || "solid"}, hoverinfo: "name"});
  };
  (field.zone_mm || []).forEach((part, i) => area(i ? `required zone, part ${i + 1}` : "required zone", part, "#1b7f4b", "rgba(27,127,75,0.16)"));
  const eyes = ["left eye", "right eye"];
  (field.outlines_mm || []).forEach((outline, i) => area(`shown to the ${eyes[i] || "eye"}`, outline, ["#1f5fbf", "#b35c00"][i % 2], null, "dash"));
  area("looked at for blind places", blind.region_mm, "#8a94a0", null, "dot");
  if (isNumber(vehicle.side_left_mm))
    traces.push({type: "scatter", mode: "lines", name: "side of the vehicle", x: [-vehicle.side_left_mm / 1000, -vehicle.side_left_mm / 1000],
                 y: [2, -6], line: {color: "#1d2733", width: 2}, hoverinfo: "name"});
  traces.push({type: "scatter", mode: "markers", name: "eyes", x: [0], y: [0], marker: {color: "#b3261e", size: 9}, hoverinfo: "name"});
  // As near as there is something to tell: the cut for the horizon lies far beyond.
  const deepest = Math.min(field.far_mm || 60000, 60000) / 1000;
  return figure("Field of view on the road", "m, seen from above, forward is up", traces, {
    // Ranges end between ticks: those of both axes would meet in the corner.
    xaxis: {title: {text: "to the right, m", standoff: 6}, zeroline: false, range: [-23, 23], dtick: 10, ticks: "outside", constrain: "domain"},
    yaxis: {title: {text: "ahead, m", standoff: 6}, zeroline: false, range: [-deepest - 3, 6], dtick: 10, ticks: "outside", scaleanchor: "x",
            constrain: "domain"},
    margin: {l: 54, r: 12, t: 34, b: 130}, legend: {orientation: "h", x: 0, y: -0.12, yanchor: "top"}
  }, true);
}

function glassMaps(mirror) {
  const points = ((mirror.map || {}).points || []).map((p) => ({...p, x: p.xy_mm[0], y: p.xy_mm[1]}));
  const grid = gridOf(points, (p) => p.x, (p) => p.y);
  if (!grid) return [];
  const maps = [
    {title: "Smaller principal radius", unit: "mm", value: (p) => Math.min(...[p.radius1_mm, p.radius2_mm].filter(isNumber)), digits: 1},
    {title: "Tangential magnification", unit: "", value: (p) => p.tangential, digits: 4},
    {title: "Sagittal magnification", unit: "", value: (p) => p.sagittal, digits: 4},
    {title: "Astigmatism", unit: "D, at the eye", value: (p) => p.astigmatism_d, digits: 4}
  ];
  return maps.flatMap((map) => {
    const values = grid.cells.map((row) => row.map((p) => (p && isNumber(map.value(p)) ? map.value(p) : null)));
    if (!values.flat().some(isNumber)) return [];
    const text = grid.cells.map((row) => row.map((p) => (p ? `${map.title}: <b>${shown(map.value(p), map.digits)}</b><br>at ${signed(p.x, 1)}, ${signed(p.y, 1)} mm` : "")));
    return [contourMap(map.title, map.unit, grid, values, text, {x: "level on the glass, mm", y: "upright on the glass, mm"}, "range")];
  });
}

function clausesTable(mirror) {
  if (!mirror.clauses || !mirror.clauses.length) return null;
  return make("div", {}, make("h3", {}, `${mirror.rule} `, verdict(mirror.pass, mirror.rests_on_unverified)),
              make("p", {class: "quiet"}, mirror.rule_edition || ""), table("", [
    {title: "Clause", value: (c) => c.clause}, {title: "Requirement", value: (c) => c.requirement},
    {title: "Value", value: (c) => c.value, digits: 3}, {title: "Limit", value: (c) => c.limit, digits: 3}, {title: "Unit", value: (c) => c.unit},
    {title: "Verdict", value: (c) => verdict(c.pass, c.certainty === "unverified")}, {title: "Certainty of the figure", value: (c) => c.certainty},
    {title: "Note", value: (c) => c.note || ""}
  ], mirror.clauses));
}

function mirrorSection(mirror) {
  const field = mirror.field || {}, view = mirror.magnification || {}, blind = mirror.blind_zone || {}, radius = mirror.radius_mm || {};
  const section = make("section", {}, make("h2", {}, mirror.mirror));
  section.append(facts([
    ["Mean radius", isNumber(mirror.mean_radius_mm) ? `${shown(mirror.mean_radius_mm, 1)} mm` : "plane"],
    ["Principal radii", `${shown(radius.min, 0)} to ${shown(radius.max, 0)} mm`],
    ["Required zone seen", isNumber(field.coverage) ? `${shown(100 * field.coverage, 1)} % of ${shown(field.required_m2, 1)} m²` : "none asked for"],
    ["Seen of the road there", `${shown(field.covered_m2, 1)} m², ${shown(field.hidden_m2, 1)} m² more hidden by the vehicle`],
    ["Blind between mirror and direct view", `${shown(blind.blind_m2, 1)} of ${shown(blind.region_m2, 1)} m²`],
    ["Magnification, middle", `${shown(view.tangential, 3)} in, ${shown(view.sagittal, 3)} across the plane of incidence`],
    ["Astigmatism, middle", `${shown(view.astigmatism_d, 4)} D`]
  ]));
  if (mirror.picture)
    section.append(make("figure", {class: "picture"}, make("img", {src: mirror.picture, alt: `The view in ${mirror.mirror}`}),
                        make("figcaption", {}, "The scene from the eye.")));
  section.append(clausesTable(mirror) || "", make("div", {class: "plots"}, fieldPlan(mirror), ...glassMaps(mirror)));
  if (field.margins && field.margins.length)
    section.append(details("Margins of the field beyond the zone's edges", table("", [
      {title: "From (behind, left), m", value: (m) => `${shown(m.from_mm[0] / 1000, 1)}, ${shown(m.from_mm[1] / 1000, 1)}`},
      {title: "to, m", value: (m) => `${shown(m.to_mm[0] / 1000, 1)}, ${shown(m.to_mm[1] / 1000, 1)}`},
      {title: "Margin, m", value: (m) => m.margin_mm / 1000, digits: 2, sign: true}
    ], field.margins)));
  if (mirror.aim)
    section.append(details("Aim", facts([["Yaw", `${shown(mirror.aim.yaw_deg, 3)}°`], ["Pitch", `${shown(mirror.aim.pitch_deg, 3)}°`],
                                          ["Coverage before", `${shown(100 * mirror.aim.coverage_before, 1)} %`],
                                          ["Coverage aimed", `${shown(100 * mirror.aim.coverage, 1)} %`]])));
  for (const note of mirror.notes || []) section.append(make("p", {class: "quiet"}, note));
  return section;
}
