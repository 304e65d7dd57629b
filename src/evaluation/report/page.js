// Puts the report on the page.
const report = JSON.parse(document.getElementById("data").textContent);
const byId = id => document.getElementById(id);
const {summary} = report;
const titleOf = name => report.methods[name]?.title ?? name;
const answer = summary.model_mean_field ?? summary.model;

function showAbout() {
  const clips = `${summary.clips} ${summary.clips === 1 ? "clip" : "clips"}`;
  const parts = [summary.model_file, `${clips}, ${summary.frames} frames`, `protocol: ${summary.protocol}`];
  if (summary.fit === "track") parts.push("all methods fitted to the 2D track");
  const samples = summary.samples > 1 ? `${summary.samples} samples` : "one sample";
  parts.push(summary.temperature > 0 ? `${samples} a clip at temperature ${summary.temperature}` : "mean field");
  if (summary.training_clips) parts.push(`trained on: ${summary.training_clips}`);
  byId("about").textContent = parts.join(" · ");
  byId("omission").textContent = report.omission;
}

function card(title, value, unit, comparison, verdict) {
  const box = element("div", {class: "card"}, element("span", {}, title), element("b", {}, value, element("small", {}, unit)));
  if (comparison) box.append(element("em", {class: verdict}, comparison));
  return box;
}

function showCards() {
  const others = Object.entries(summary.baselines);
  const best = (figure, sign) => others.filter(([, s]) => s[figure] !== null).sort((a, b) => sign * (a[1][figure] - b[1][figure]))[0];
  const add = (title, figure, digits, unit, sign) => {
    if (answer[figure] === null) return;
    const rival = best(figure, sign);
    const own = answer[figure].toFixed(digits), theirs = rival?.[1][figure].toFixed(digits);
    const wins = rival && sign * (answer[figure] - rival[1][figure]) < 0;
    const [verdict, word] = own === theirs ? ["note", "level with"] : wins ? ["good", "beats"] : ["bad", "behind"];
    byId("cards").append(card(title, own, unit, rival && `${word} ${titleOf(rival[0])}: ${theirs}`, verdict));
  };
  add("Mean joint error (MPJPE)", "mpjpe_mm", 1, "mm", 1);
  add("Correlation per channel", "pcc_channel", 3, "PCC", -1);
  add("Correlation, flattened", "pcc_flat", 4, "PCC", -1);
  add("Root error", "root_mm", 0, "mm", 1);
}

function showVerdicts() {
  const signs = {good: "✓", bad: "✗", note: "i"};
  byId("verdicts").append(...summary.verdicts.map(verdict =>
    element("li", {class: verdict.kind}, element("i", {"aria-label": verdict.kind}, signs[verdict.kind]), element("span", {}, verdict.text))));
}

function showComparison() {
  const rows = [["model", summary.model], ...(summary.model_mean_field ? [["model_mean_field", summary.model_mean_field]] : []),
    ...Object.entries(summary.baselines)];
  const bars = figure => rows.filter(([, score]) => score[figure] !== null)
    .map(([name, score]) => ({label: name === "model" && summary.model_mean_field ? "model, samples" : titleOf(name),
      value: score[figure], model: name.startsWith("model")}));
  byId("comparison").append(barChart("Mean joint error in mm, shorter is better", bars("mpjpe_mm"), 1),
    barChart("PCC per channel, longer is better", bars("pcc_channel"), 3),
    barChart("Acceleration error in m/s², shorter is better",
      bars("acceleration_error_mm_s2").map(bar => ({...bar, value: bar.value / 1000})), 2),
    element("dl", {class: "methods"}, ...rows.filter(([name]) => report.methods[name]?.sentence)
      .flatMap(([name]) => [element("dt", {}, titleOf(name)), element("dd", {}, report.methods[name].sentence)])));
}

function showFigures() {
  const actions = [...new Set(report.figures.map(figure => figure.action))];
  for (const action of actions) {
    const about = summary.actions.find(a => a.name === action);
    const title = element("h3", {class: "action-title"}, `${action} (${about.clips} ${about.clips === 1 ? "clip" : "clips"})`);
    if (about.training_clips) title.append(element("span", {class: "mark"}, `${about.training_clips} trained on`));
    byId("figure-list").append(title, element("div", {class: "figure-grid"},
      ...report.figures.filter(f => f.action === action && f.series.length).map(histogramFigure)));
  }
}

function switchTheme() {
  const root = document.documentElement;
  const dark = root.dataset.theme ? root.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  root.dataset.theme = dark ? "light" : "dark";
}

showAbout();
showCards();
showVerdicts();
showComparison();
showFigures();
byId("table-list").append(...report.tables.map(table => tableView(table, ["table_3.csv", "methods.csv"].includes(table.file))));
byId("theme").addEventListener("click", switchTheme);
if (report.clips.length) new Viewer(report.clips);
else document.querySelector(".viewer").hidden = true;
