const page = {
  figures: ["map", "history", "base"],
  maps: ["map"],
  messages: { view: show, verdict, legend, progress, refused },
};

// ---- the view

const rounded = (value, digits = 4) => String(Number(Number(value).toPrecision(digits)));
const brief = text => (/^-?\d*\.?\d+(e.*)?$/.test(text) && text.length > 8 ? rounded(text, 6) : text);

function show(view) {
  const before = shown;
  shown = view;
  const channel = find("channel");
  channel.replaceChildren(...view.channels.map((name, n) => new Option(name ? `${n + 1}: ${name}` : String(n + 1), n + 1)));
  const verticals = view.verticals.map(([n, name]) => new Option(`${n}: ${name}`, n));
  find("vertical").replaceChildren(new Option("none", ""), ...verticals);
  for (const [name, text] of Object.entries(view.fields)) {
    const field = document.querySelector(`#fields [name="${name}"]`);
    if (field && !field.dataset.typing) field.value = field.tagName === "INPUT" && document.activeElement !== field ? brief(text) : text;
  }
  place(view.fields.source);
  for (const label of all("#fields [data-model]")) label.hidden = label.dataset.model !== view.fields.model;
  remember(view, before);
  if (!sliding) find("slider").value = slot(view.fields.scale);
  find("pga").textContent = `PGA ${rounded(view.ground.pga * view.fields.scale, 3)} g`;
  find("link-text").textContent = location.href;
  find("link-note").hidden = view.fields.source !== "file";
  find("ground-name").textContent = view.ground.title;
  models.base.title.setv({ text: shortened(`Acceleration of the base: ${view.ground.title}`, find("base")) }, { sync: false });
  find("ground-facts").replaceChildren(...rows(view.ground.facts));
  find("ground-note").textContent = view.ground.note;
  find("left-out").textContent = view.left_out;
  outdate(view);
}

// Shorten the title of a figure to what fits: a bold letter of 12 px is less than 8 px wide on average. Its name is below in full.
function shortened(title, figure) {
  const most = Math.max(20, Math.floor(figure.clientWidth / 8));
  return title.length > most ? `${title.slice(0, most - 1).trimEnd()}…` : title;
}

// Fields of the pulse and of the file are visible only for these sources.
function place(source) {
  find("source").value = source;
  const missing = source === "file" && (Boolean(find("file-refused").textContent) || shown?.fields.units || shown?.fields.step);
  for (const label of all("#fields [data-for]")) label.hidden = label.dataset.for !== source || (label.dataset.if === "missing" && !missing);
  find("channel-label").hidden = source !== "file" || (shown?.channels.length ?? 0) < 2;
  find("vertical-label").hidden = source !== "file" || !shown?.verticals.length;
}

function refused(message) {
  refuse(message);
  if (message.fields.file) place("file");
}

for (const field of all("#fields input:not([type]), #fields select")) {
  if (field.tagName === "INPUT") field.addEventListener("input", () => { field.dataset.typing = "yes"; });
  field.addEventListener("change", () => {
    delete field.dataset.typing;
    if (field.name === "source") {
      place(field.value);
      if (field.value === "file" && !shown?.channels.length) return find("file").click();
    }
    ask("fields", typed(field));
  });
}

// A field as it is typed, with those that were refused before and fit only together with it.
const TIED = ["channel", "vertical", "model", "stiffness", "prestress", "mass", "friction"];
function typed(field) {
  const refused = each => !each.closest("label").hidden && each.value !== brief(shown.fields[each.name]);
  const others = TIED.includes(field.name) ? TIED.map(find).filter(refused) : [];
  return Object.fromEntries([field, ...others].map(each => [each.name, each.value]));
}

// ---- files stay between this page and the server on the same computer

const MOST = 50e6;

async function give(file) {
  if (!file) return;
  refuse({ fields: {} });
  if (file.size > MOST) return refused({ fields: { file: `${file.name}: larger than 50 MB` } });
  link.file = { name: file.name, data: await file.arrayBuffer() };
}

find("file").addEventListener("change", event => give(event.target.files[0]));
for (const type of ["dragover", "dragleave", "drop"]) {
  document.addEventListener(type, event => {
    if (!event.dataTransfer?.types.includes("Files")) return;
    event.preventDefault();
    document.body.classList.toggle("dropping", type === "dragover");
    if (type === "drop") { place("file"); give(event.dataTransfer.files[0]); }
  });
}

// ---- the scale

const ENDS = [0.1, 20]; // of the slider; the field takes more
const slot = scale => 1000 * Math.log(scale / ENDS[0]) / Math.log(ENDS[1] / ENDS[0]);
function slid(push) {
  const scale = rounded(ENDS[0] * (ENDS[1] / ENDS[0]) ** (find("slider").value / 1000), 3);
  ask("fields", { scale }, push);
}

// ---- the map: the browser zooms and pans, the server computes

let timer;
const spans = () => [models.map.x_range, models.map.y_range].map(({ start, end }) => [start, end]);

function moved() {
  clearTimeout(timer);
  timer = setTimeout(() => {
    const [sizes, angles] = spans();
    const same = (span, other) => span.every((end, n) => Math.abs(end / other[n] - 1) < 1e-12);
    if (!shown || (same(sizes, shown.sizes) && same(angles, shown.angles))) return;
    ask("fields", { sizes: sizes.join(":"), angles: angles.join(":") });
  }, 150);
}

function zoom(by) {
  const [[left, right], [low, high]] = spans(), clamp = (value, [least, most]) => Math.min(Math.max(value, least), most);
  const middle = Math.sqrt(left * right), wide = Math.sqrt(right / left) ** (1 / by), centre = (low + high) / 2, half = (high - low) / 2 / by;
  const { x_range, y_range } = models.map;
  x_range.setv({ start: clamp(middle / wide, x_range.bounds), end: clamp(middle * wide, x_range.bounds) });
  y_range.setv({ start: clamp(centre - half, y_range.bounds), end: clamp(centre + half, y_range.bounds) });
}
for (const button of all("[data-zoom]")) button.onclick = () => zoom(Number(button.dataset.zoom));
find("whole").onclick = () => ask("fields", { sizes: "0.2:10", angles: "3:30" });

function block(at, side) {
  const [left, right] = shown.sizes, [low, high] = shown.angles;
  const size = left * (right / left) ** (at % side / (side - 1)), angle = low + (high - low) * Math.floor(at / side) / (side - 1), radians = angle * Math.PI / 180;
  const overturns = answers.map.outcome[at] === 2, peak = answers.map.peak[at];
  return { size, angle, height: 2 * size * Math.cos(radians), width: 2 * size * Math.sin(radians), peak, margin: answers.map.margin[at], certified: answers.map.certified[at],
    outcome: overturns ? "overturns" : peak > 0 ? "rocks and stands" : "stands still" };
}

function readout(across, up) {
  const side = Math.round(Math.sqrt(answers.map.outcome.length)), { x_range, y_range } = models.map, [left, right] = shown.sizes, [low, high] = shown.angles;
  const size = x_range.start * (x_range.end / x_range.start) ** across, angle = y_range.start + up * (y_range.end - y_range.start);
  const column = Math.round(Math.log(size / left) / Math.log(right / left) * (side - 1)), row = Math.round((angle - low) / (high - low) * (side - 1));
  if (column < 0 || row < 0 || column >= side || row >= side) return;
  const result = block(row * side + column, side);
  const reach = result.outcome === "rocks and stands" ? `, largest angle ${rounded(result.peak * result.angle, 3)}° = ${rounded(result.peak, 3)} θcr` : "";
  const place = `Height ${rounded(result.height, 3)} m, width ${rounded(result.width, 3)} m (R ${rounded(result.size, 3)} m, θcr ${rounded(result.angle, 3)}°): `;
  return [place, strong(result.outcome), reach + (result.certified ? "" : "; not certified")];
}

// ---- verdict and legend

function verdict(message) {
  conclude({ ...message, evidence: "" });
  find("evidence").replaceChildren(...[message.margin, message.certified, ...message.validity].map((sentence, n) => {
    const line = document.createElement("span");
    line.textContent = sentence;
    if (n === 1 && !message.decided) line.className = "undecided";
    return line;
  }));
}

function legend(message) {
  find("legend").replaceChildren(
    entry("stands still", message.stands.colour, message.stands.share),
    entry("rocks and stands, largest |θ|/θcr 0 to 1", `linear-gradient(90deg, ${message.rocks.colours.join(", ")})`, message.rocks.share, true),
    entry("overturns", message.overturns.colour, message.overturns.share),
  );
  if (message.undecided) find("legend").append(Object.assign(document.createElement("li"), { textContent: `not certified: ${message.undecided}` }));
  find("map").setAttribute("aria-label", `Map of outcomes over size and critical angle: stands still ${message.stands.share}, rocks and stands ${message.rocks.share}, overturns ${message.overturns.share}. Enter height and width to select a block.`);
}

// ---- the animation, seen from the base

function scene() {
  const { time, angle: degrees } = columns("history"), { height, width, critical, centre, wall, restrained } = shown.block;
  shoot(Array.from(degrees, value => value * Math.PI / 180 / critical), critical, height, { time, width, centre, wall, restrained, moves: 1, displacement: () => 0, speed: 1 });
  clock = Math.min(clock, time[time.length - 1] ?? 0);
  find("scale-note").textContent = film.angles > 1.05 ? `angle × ${film.angles.toPrecision(2)}` : "true to scale";
  frame();
}

// ---- export

const headings = { time: "time [s]", angle: "angle [°]", acceleration: "acceleration [g]" };

// Columns of a figure with their headings; undefined if it is not computed yet.
function table(name) {
  if (name !== "map") return Object.fromEntries(Object.entries(columns(name)).map(([column, values]) => [headings[column], values]));
  if (!answers.map) return;
  const side = Math.round(Math.sqrt(answers.map.outcome.length)), points = Array.from(answers.map.outcome, (_, at) => block(at, side));
  const names = { size_m: "size", critical_angle_deg: "angle", height_m: "height", width_m: "width", outcome: "outcome", peak: "peak", margin: "margin", certified: "certified" };
  return Object.fromEntries(Object.entries(names).map(([title, key]) => [title, points.map(each => each[key])]));
}

find("netcdf").onclick = () => ask("save", {});
