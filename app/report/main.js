// Puts the page together from the data that stand in it.
"use strict";

(async () => {
  const report = JSON.parse(document.getElementById("data").textContent);
  document.title = report.title;
  document.querySelector("h1").textContent = report.title;
  document.getElementById("summary").textContent = report.summary || "";
  const main = document.querySelector("main");
  if (report.batch) main.append(batchSection(report.batch));
  for (const lens of report.lenses || []) main.append(lensSection(lens));
  for (const mirror of report.mirrors || []) main.append(mirrorSection(mirror));
  const footer = document.querySelector("footer");
  const versions = Object.entries(report.versions || {}).map(([name, version]) => `${name} ${version}`);
  footer.append(make("p", {}, versions.join(" · ")));
  for (const input of report.inputs || [])
    footer.append(make("p", {}, `${input.file}: SHA-256 `, make("code", {}, input.sha256)));
  await drawAll();
})();
