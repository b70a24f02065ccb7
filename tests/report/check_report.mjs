// Opens a report as a person would, on a laptop and on a phone, and fails with a sentence where something is not as it should be.
//   node check_report.mjs REPORT.html PLOTS FOLDER_OF_SCREENSHOTS
import {chromium} from "playwright-core";
import {existsSync} from "node:fs";
import {pathToFileURL} from "node:url";
import path from "node:path";

const [file, plots, folder] = process.argv.slice(2);
const complaints = [];
const expect = (condition, sentence) => { if (!condition) complaints.push(sentence); };

const browserProgram = process.env.CHROMIUM || "/usr/bin/chromium";
if (!existsSync(browserProgram)) {
  console.error(`${browserProgram} is missing: apt-get install chromium (scripts/setup.sh --tests does), or name a browser by CHROMIUM`);
  process.exit(1);
}
const browser = await chromium.launch({
  executablePath: browserProgram,
  args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"]
});
for (const [device, width, height] of [["laptop", 1366, 768], ["phone", 390, 844]]) {
  const page = await browser.newPage({viewport: {width, height}});
  page.on("console", (message) => { if (["error", "warning"].includes(message.type())) complaints.push(`${device}: console: ${message.text()}`); });
  page.on("pageerror", (error) => complaints.push(`${device}: ${error}`));
  page.on("request", (request) => { if (!/^(file|data|blob):/.test(request.url())) complaints.push(`${device}: asks the network for ${request.url()}`); });
  await page.goto(pathToFileURL(path.resolve(file)).href);
  await page.waitForFunction(() => document.documentElement.dataset.ready !== undefined, null, {timeout: 60000});

  const seen = await page.evaluate(() => ({
    ready: Number(document.documentElement.dataset.ready),
    title: document.title,
    // A plot is drawn where its layer of traces has paths of some size.
    plots: [...document.querySelectorAll(".plot")].map((plot) => {
      const box = plot.querySelector(".plot-container .main-svg")?.getBoundingClientRect();
      return {name: plot.getAttribute("aria-label"), width: box?.width || 0, height: box?.height || 0,
              marks: plot.querySelectorAll(".plot path, .cartesianlayer path, .cartesianlayer image").length};
    }),
    // Tick labels that meet read as one number; a whole pixel of overlap counts.
    meeting: [...document.querySelectorAll(".plot")].flatMap((plot) => {
      const ticks = [...plot.querySelectorAll(".xtick text, .ytick text")].map((t) => ({text: t.textContent, box: t.getBoundingClientRect()}));
      return ticks.flatMap((a, i) => ticks.slice(i + 1)
        .filter((b) => Math.min(a.box.right, b.box.right) - Math.max(a.box.left, b.box.left) > 1 &&
                       Math.min(a.box.bottom, b.box.bottom) - Math.max(a.box.top, b.box.top) > 1)
        .map((b) => `${plot.getAttribute("aria-label")}: ${a.text} and ${b.text}`));
    }),
    // Maps whose points fill a circle end at it, not along the steps of their grid: one shape, and values up to it all round.
    ragged: [...document.querySelectorAll(".plot")].filter((plot) => plot.data?.[0]?.type === "contour").filter((plot) => {
      const {x, y, z} = plot.data[0], corner = [z[0], z[z.length - 1]].some((row) => [row[0], row[row.length - 1]].includes(null));
      const sides = [z[0][x.length >> 1], z[y.length - 1][x.length >> 1], z[y.length >> 1][0], z[y.length >> 1][x.length - 1]];
      return corner && sides.every((v) => v !== null) && Math.abs(x[0] - y[0]) < 1e-6 && !plot.layout.shapes?.length;
    }).map((plot) => plot.getAttribute("aria-label")),
    wider: document.documentElement.scrollWidth - document.documentElement.clientWidth,
    smallest: Math.min(...[...document.querySelectorAll("p, td, th, dd, dt, figcaption, li, h1, h2, h3")]
      .filter((node) => node.textContent.trim()).map((node) => parseFloat(getComputedStyle(node).fontSize))),
    pictures: [...document.images].map((image) => image.naturalWidth)
  }));
  expect(seen.title && seen.title !== "Catoptra", `${device}: the page has no title of its own`);
  expect(seen.plots.length === Number(plots), `${device}: ${seen.plots.length} plots, expected ${plots}`);
  expect(seen.ready === seen.plots.length, `${device}: ${seen.ready} of ${seen.plots.length} plots were drawn`);
  for (const plot of seen.plots)
    expect(plot.marks > 0 && plot.width > 150 && plot.height > 150, `${device}: plot '${plot.name}' is empty (${plot.marks} marks, ${plot.width} x ${plot.height})`);
  for (const pair of seen.meeting) expect(false, `${device}: tick labels meet in ${pair}`);
  for (const name of seen.ragged) expect(false, `${device}: the map '${name}' of points within a circle has a ragged edge`);
  expect(seen.wider <= 0, `${device}: the page is ${seen.wider} px wider than the window`);
  expect(seen.smallest >= 12, `${device}: text of ${seen.smallest} px`);
  for (const natural of seen.pictures) expect(natural > 0, `${device}: a picture does not load`);

  if (device === "laptop" && seen.plots.length > 0) {  // the numbers under the pointer
    const plot = page.locator(".plot").first();
    await plot.scrollIntoViewIfNeeded();
    const box = await plot.locator(".nsewdrag").first().boundingBox();
    const marks = await plot.locator(".scatterlayer .point").all();  // of a scatter plot; a map answers anywhere
    const places = marks.length ? [await marks[0].boundingBox()].map((b) => [b.x + b.width / 2, b.y + b.height / 2])
                                : [[0.5, 0.5], [0.45, 0.4], [0.55, 0.6]].map(([u, v]) => [box.x + u * box.width, box.y + v * box.height]);
    let hover = 0;
    for (const [x, y] of places) {
      await page.mouse.move(x - 30, y - 30);
      await page.mouse.move(x, y, {steps: 4});
      await page.waitForTimeout(400);
      hover = await plot.locator(".hoverlayer .hovertext").count();
      if (hover > 0) break;
    }
    expect(hover > 0, "laptop: nothing is told under the pointer");
  }
  await page.screenshot({path: path.join(folder, `${path.basename(file, ".html")}-${device}.png`), fullPage: true});
  await page.close();
}
await browser.close();
for (const complaint of complaints) console.error(complaint);
process.exit(complaints.length ? 1 : 0);
