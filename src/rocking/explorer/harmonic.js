const page = {
  figures: ["map", "basin", "history", "portrait", "section", "spectrum", "diagram"],
  maps: ["map", "basin"],
  messages: { view: show, verdict: conclude, legend, progress, basin: attractors, gallery, refused: refuse },
};
const still = new Set(); // maps whose ranges the page itself is setting

// ---- the view and its address

// Rounded to the width of a field. In the field with the focus, all digits can be edited.
function brief(text) {
  if (text.length <= 8) return text;
  const rounded = [4, 3, 2, 1].map(digits => String(Number(Number(text).toPrecision(digits))));
  return "≈" + (rounded.find(each => each.length <= 7) ?? rounded[3]);
}

function show(view) {
  const before = shown;
  shown = view;
  for (const [name, text] of Object.entries(view.fields)) {
    const input = document.querySelector(`#fields [name="${name}"]`);
    if (!input) continue;
    input.title = brief(text) === text ? "" : text;
    if (document.activeElement !== input) input.value = brief(text);
    else if (!input.dataset.typing) input.value = text;
  }
  if (view.si !== before?.si) units(view);
  find("model").value = view.fields.critical_angle ? "full" : "slender";
  const on = new Set(view.fields.curves.split(","));
  for (const box of all("#curves input")) box.checked = on.has(box.name);
  find("curves").disabled = Boolean(view.fields.brace_angle || view.fields.critical_angle || Number(view.fields.offset));
  remember(view, before);
  page.maps.forEach(steady);
  find("depth").textContent = view.planes.map.deepest ? "Zoom limit of double precision" : "";
  find("vary").value = view.fields.vary;
  const [low, high, value] = view.slider;
  if (document.activeElement !== find("slider") || !sliding) find("slider").value = 1000 * (value - low) / (high - low);
  find("python").textContent = view.python;
  find("commands").textContent = view.commands;
  find("link-text").textContent = location.href;
  outdate(view);
}

// ---- normalised quantities, or SI for a block

let size = { height: "2", width: "0.5" }; // of the last block

function units(view) {
  document.body.dataset.units = find("units").value = view.si ? "si" : "";
}

find("units").onchange = event => {
  if (shown.si) size = { height: shown.fields.height, width: shown.fields.width };
  const si = event.target.value;
  units(shown); // until the view with the other units is there: a block with an offset keeps SI
  ask("fields", si ? size : { height: "", width: "" });
};
find("model").onchange = event => ask("fields", { critical_angle: event.target.value === "full" ? shown.full : "" });

// ---- maps: the browser zooms and pans, the server computes

const timers = {};

function steady(name) {
  still.add(name);
  const [left, right, bottom, top] = shown.planes[name].ranges, { x_range, y_range } = models[name];
  x_range.setv({ start: left, end: right });
  y_range.setv({ start: bottom, end: top });
  still.delete(name);
}

const ends = name => [models[name].x_range.start, models[name].x_range.end, models[name].y_range.start, models[name].y_range.end];
const spans = { map: ["periods", "amplitudes"], basin: ["angles", "velocities"] };

function moved(name) {
  if (!shown || still.has(name)) return;
  clearTimeout(timers[name]);
  timers[name] = setTimeout(() => settle(name), 130);
}

function settle(name) {
  const now = ends(name), { ranges, base } = shown.planes[name];
  if (now.every((end, place) => end === ranges[place])) return;
  ask("fields", {
    [spans[name][0]]: `${base[0] + now[0]}:${base[0] + now[1]}`,
    [spans[name][1]]: `${base[1] + now[2]}:${base[1] + now[3]}`,
  });
}

function zoom(name, by, right = 0, up = 0) {
  for (const [range, shift] of [[models[name].x_range, right], [models[name].y_range, up]]) {
    const width = range.end - range.start, next = Math.max(width / by, range.min_interval);
    let low = range.start + (width - next) / 2 + shift * width, high = low + next;
    const [least, most] = range.bounds;
    if (low < least) { low = least; high = Math.min(least + next, most); }
    if (high > most) { high = most; low = Math.max(most - next, least); }
    range.setv({ start: low, end: high });
  }
}

for (const button of all("[data-zoom]")) button.onclick = () => zoom(button.dataset.zoom, Number(button.dataset.by));
for (const button of all("[data-whole]")) button.onclick = () => ask("fields", shown.whole[button.dataset.whole]);
for (const name of page.maps) {
  const keys = {
    "+": () => zoom(name, 2), "=": () => zoom(name, 2), "-": () => zoom(name, 0.5), "0": () => ask("fields", shown.whole[name]),
    ArrowLeft: () => zoom(name, 1, -0.1), ArrowRight: () => zoom(name, 1, 0.1), ArrowDown: () => zoom(name, 1, 0, -0.1), ArrowUp: () => zoom(name, 1, 0, 0.1),
  };
  find(name).addEventListener("keydown", event => {
    if (keys[event.key] && !event.ctrlKey && !event.altKey && !event.metaKey) { event.preventDefault(); keys[event.key](); }
  });
}

// ---- readout of the map at a point

function readout(across, up) {
  const source = answers.map, side = Math.round(Math.sqrt(source.look.length));
  const { x_range, y_range } = models.map, [left, right, bottom, top] = shown.planes.map.ranges;
  const x = x_range.start + across * (x_range.end - x_range.start), y = y_range.start + up * (y_range.end - y_range.start);
  const column = Math.round((x - left) / (right - left) * (side - 1)), row = Math.round((y - bottom) / (top - bottom) * (side - 1));
  if (column < 0 || row < 0 || column >= side || row >= side) return;
  const at = row * side + column, look = source.look[at], repeats = source.response_period[at], impacts = source.impacts_per_period[at];
  const ground = source.evidence[at], exponent = source.exponent[at], [baseX, baseY] = shown.planes.map.base;
  const notes = [];
  if (repeats > 0) notes.push(`repeats after ${repeats} cycle${repeats > 1 ? "s" : ""}` + (impacts >= 0 ? `, ${impacts} impact${impacts === 1 ? "" : "s"}` : ""));
  const level = constants.levels[ground] === "none" ? "" : ` (${constants.levels[ground]})`;
  notes.push(constants.grounds[ground] + level);
  if (exponent === -Infinity) notes.push("λ₁ = −∞"); else if (Number.isFinite(exponent)) notes.push(`λ₁ = ${exponent.toPrecision(3).replace("-", "−")} per ${shown.si ? "s" : "τ"}`);
  const digits = span => Math.min(17, Math.max(4, 3 - Math.floor(Math.log10(span))));
  const period = (baseX + x).toPrecision(digits((right - left) / Math.abs(baseX + x))), amplitude = (baseY + y).toPrecision(digits((top - bottom) / Math.max(Math.abs(baseY + y), 1e-9)));
  const place = shown.si ? `${period} s (${(1 / (baseX + x)).toPrecision(4)} Hz), ${amplitude} m/s²: ` : `T = ${period}, A = ${amplitude}: `;
  const name = constants.looks[look] ?? "invalid initial state", awaits = name === "undetermined" && document.body.dataset.map !== "done";
  return [place, ...(awaits ? [strong("not yet decided")] : [strong(name), ["", ...notes].join("; ")])];
}

// ---- verdict, legends and messages

function entries(legend) {
  return legend.map(each => {
    const stripes = each.hatch ? `repeating-linear-gradient(135deg, ${each.hatch} 0 2px, transparent 2px 5px), ` : "";
    const row = entry(each.name, stripes + each.colour, each.share);
    row.classList.toggle("none", !each.share);
    return row;
  });
}

const shares = legend => legend.filter(each => each.share).map(each => `${each.name} (${each.share})`).join(", ");

function legend({ legend }) {
  find("legend").replaceChildren(...entries(legend));
  find("map").setAttribute("aria-label", `Map of responses over period and amplitude: ${shares(legend)}. Arrow keys move the view, plus and minus zoom, 0 resets it. Enter numbers to select a point.`);
}

function attractors({ legend }) {
  find("attractors").replaceChildren(...entries(legend));
  find("basin").setAttribute("aria-label", `Basins of attraction: ${shares(legend)}. Arrow keys move the view, plus and minus zoom, 0 resets it. Enter numbers to select an initial state.`);
}

// ---- controls

for (const input of all("#fields input")) {
  input.addEventListener("focus", () => {
    if (!input.value.startsWith("≈")) return;
    input.value = shown.fields[input.name];
    input.select(); // as after Tab; a click then sets the caret
  });
  input.addEventListener("blur", () => { if (input.value === shown?.fields[input.name]) input.value = brief(input.value); });
  input.addEventListener("input", () => { input.dataset.typing = "yes"; });
  input.addEventListener("change", () => { delete input.dataset.typing; ask("fields", { [input.name]: input.value }); });
  input.addEventListener("keydown", event => {
    if (event.key === "Escape") { delete input.dataset.typing; input.value = shown.fields[input.name]; refuse({ fields: {} }); }
  });
}
for (const box of all("#curves input")) box.onchange = () => ask("fields", { curves: all("#curves input:checked").map(each => each.name).join(",") });
document.querySelector("[data-opens=gallery]").addEventListener("click", () => { if (!link.gallery) ask("gallery", {}, false); });
function gallery({ pictures }) {
  for (const [name, path] of Object.entries(pictures)) document.querySelector(`[data-case="${name}"] path`).setAttribute("d", path);
}
find("vary").onchange = event => ask("fields", { vary: event.target.value });

const slid = push => {
  const [low, high] = shown.slider, value = low + (high - low) * find("slider").value / 1000;
  // the fewest digits that distinguish two steps
  const short = Number(value.toFixed(Math.max(Math.ceil(-Math.log10((high - low) / 1000)), 0)));
  ask("fields", { [shown.fields.vary]: String(Math.min(Math.max(short, low), high)) }, push);
};

for (const button of all("[data-case]")) button.onclick = () => { find("gallery").close(); ask("case", { name: button.dataset.case }); };

// ---- files

// Columns of a figure with their headings; undefined if it is not computed yet.
function table(name) {
  const found = name === "map" ? grid(name, "period", "amplitude") : name === "basin" ? grid(name, "angle", "velocity")
    : name === "section" ? answers.section : columns(name);
  return found && Object.fromEntries(Object.entries(found).map(([column, values]) => [shown.headings[column] ?? column, values]));
}

function grid(name, across, up) {
  const source = answers[name];
  if (!source) return;
  const side = Math.round(Math.sqrt(source.look.length)), [left, right, bottom, top] = shown.planes[name].ranges, [baseX, baseY] = shown.planes[name].base;
  const at = (low, high, place) => low + (high - low) * place / (side - 1);
  return {
    [across]: Array.from(source.look, (_, n) => baseX + at(left, right, n % side)),
    [up]: Array.from(source.look, (_, n) => baseY + at(bottom, top, Math.floor(n / side))),
    response: Array.from(source.look, look => constants.looks[look] ?? ""),
    response_period: source.response_period,
    evidence: Array.from(source.evidence, ground => constants.grounds[ground]),
    exponent: source.exponent,
    ...(name === "basin" && { orbit: source.orbit }),
  };
}

// ---- the block

function scene() {
  const { time, angle } = columns("history"), { height, width, critical, centre, unit, base, frequency, phase } = shown.scene;
  shoot(Array.from(angle, value => value * unit), critical, height, { time, width, centre,
    displacement: at => -base * Math.cos(frequency * at + phase), speed: Math.max(2 * Math.PI / frequency / 1.2, (time[time.length - 1] - time[0]) / 40),
    moves: Math.min(Math.max(0.06 * height / (base || 1), 1), 60) });
  clock = time[0] ?? 0;
  const notes = [];
  if (film.angles > 1.05) notes.push(`angle × ${film.angles.toPrecision(2)}`);
  if (film.moves > 1.05 && base) notes.push(`base motion × ${film.moves.toPrecision(2)}`);
  find("scale-note").textContent = notes.join(", ") || "true to scale";
  frame();
}
