// Parts of every page of the explorer. The script of a page follows them: it declares `page`, its figures, maps and messages.
"use strict";
const constants = JSON.parse(document.getElementById("constants").textContent);
const find = id => document.getElementById(id);
const all = selector => [...document.querySelectorAll(selector)];
let link, shown, models = {}, playing = !matchMedia("(prefers-reduced-motion: reduce)").matches, requests = 0;

// ---- requests and messages

function ask(what, fields, push = true) {
  link.request = JSON.stringify({ n: ++requests, what, fields, push: push ? "yes" : "no" });
}

function listen(name, act) {
  const heard = () => { if (link[name]) act(JSON.parse(link[name])); };
  link.properties[name].change.connect(heard);
  heard();
}

function begin(doc) {
  link = doc.get_model_by_name("link");
  for (const name of page.figures) models[name] = doc.get_model_by_name(name);
  link.properties.drawn.change.connect(() => draw(link.drawn));
  link.properties.saved.change.connect(() => keep(link.saved));
  for (const [name, act] of Object.entries(page.messages)) listen(name, act);
  for (const name of page.maps) {
    for (const range of [models[name].x_range, models[name].y_range]) {
      range.properties.start.change.connect(() => moved(name));
      range.properties.end.change.connect(() => moved(name));
    }
  }
  history.replaceState({ n: depth() }, "");
  theme(document.documentElement.dataset.theme);
  ask("open", { address: location.search }, false);
  document.body.dataset.ready = "yes";
}

const waiting = setInterval(() => {
  const doc = window.Bokeh?.documents[0];
  if (!doc || !doc.is_idle || !doc.get_model_by_name("link")) return;
  clearInterval(waiting);
  begin(doc);
}, 15);

// ---- the view and its address

const depth = () => history.state?.n ?? 0;

// Put the address of a view into the history of the browser.
function remember(view, before) {
  if (view.push && before && view.address !== before.address) {
    history.pushState({ n: depth() + 1 }, "", "?" + view.address);
    sessionStorage.setItem("deepest", depth());
  } else {
    history.replaceState({ n: depth() }, "", "?" + view.address);
  }
  stack();
}

function stack() {
  find("undo").disabled = depth() === 0;
  find("redo").disabled = depth() >= Number(sessionStorage.getItem("deepest") ?? 0);
}

window.addEventListener("popstate", () => { if (link) ask("open", { address: location.search }, false); });
find("undo").onclick = () => history.back();
find("redo").onclick = () => history.forward();

// ---- contents of the figures

const parts = value => (value instanceof Map ? [...value] : Object.entries(value));
let answers = {}; // results of a figure that are not drawn, by its name: at each point of a map, and all points of a section

function draw(drawn) {
  for (const [name, contents] of parts(drawn)) if (models[name]) for (const [part, value] of parts(contents)) fill(name, part, value);
  if (parts(drawn).some(([name]) => name === "history")) scene();
  read();
}

function fill(name, part, value) {
  const figure = models[name], change = (model, to) => model.setv(to, { sync: false });
  if (part === "answers") answers[name] = Object.fromEntries(parts(value));
  else if (part === "why") find(name).dataset.why = value;
  else if (part === "label") change(figure.below[0], { axis_label: value });
  else if (["here", "above", "below"].includes(part)) change(figure.center.find(each => each.name === part), { location: value });
  else if (part === "ranges") {
    change(figure.x_range, { start: value[0], end: value[1] });
    change(figure.y_range, { start: value[2], end: value[3] });
  } else change(figure.renderers.find(each => each.data_source.name === part).data_source, { data: value });
}

// ---- what belongs to another view than the one shown

let late; // timer: a quick verdict takes the place of the one before without a flicker

function outdate({ renewed, moved }) {
  for (const name of renewed) delete answers[name];
  if (renewed.includes("map")) document.body.dataset.map = "0";
  read();
  if (!moved) return;
  find("verdict").classList.add("stale");
  late ??= setTimeout(() => write({ kind: "…", colour: "", facts: [], evidence: "" }), 250);
}

// ---- readout of the map at a point

const hint = find("readout").textContent;
let pointed; // last place of the pointer in the frame of the map, as fractions of its sides

find("map").addEventListener("pointermove", event => {
  const view = Bokeh.index.find_one(models.map), box = view?.el.getBoundingClientRect(), inner = view?.frame?.bbox;
  if (!inner) return;
  const place = [(event.clientX - box.left - inner.left) / inner.width, 1 - (event.clientY - box.top - inner.top) / inner.height];
  if (Math.min(...place) < 0 || Math.max(...place) > 1) return;
  pointed = place;
  read();
});

// Tell what the map shown has at this place, again with each map.
function read() {
  if (!pointed || !shown) return;
  find("readout").replaceChildren(...(answers.map ? readout(...pointed) ?? [hint] : ["Computing …"]));
}

function strong(text) {
  const made = document.createElement("b");
  made.textContent = text;
  return made;
}

// ---- messages

function conclude(message) {
  clearTimeout(late);
  late = undefined;
  find("verdict").classList.remove("stale");
  write(message);
}

function write(message) {
  find("kind").textContent = message.kind;
  find("verdict").querySelector("i").style.background = message.colour;
  find("sentence").textContent = message.sentence ?? "";
  find("level").textContent = message.level ?? "";
  find("facts").replaceChildren(...rows(message.facts));
  find("evidence").textContent = message.evidence;
}

function rows(facts) {
  return facts.map(([name, value]) => {
    const row = document.createElement("div"), term = document.createElement("dt"), definition = document.createElement("dd");
    term.textContent = name;
    definition.textContent = value;
    row.append(term, definition);
    return row;
  });
}

// Row of a legend: the background of its swatch, and its share of the area, which may be empty.
function entry(name, background, share, ramp = false) {
  const row = document.createElement("li"), swatch = document.createElement("i"), part = document.createElement("small");
  swatch.style.background = background;
  swatch.classList.toggle("ramp", ramp);
  part.textContent = share && `(${share})`;
  row.append(swatch, name, part);
  return row;
}

const bar = document.querySelector("#bar i");

function progress(message) {
  find("progress").textContent = message.done ? "" : `Computing the map: ${message.text}`;
  bar.style.opacity = message.done ? 0 : 1;
  bar.style.width = `${100 * message.share}%`;
  document.body.dataset.map = message.done ? "done" : String(message.side);
}

function pardon(input) {
  if (!input.hasAttribute("aria-invalid")) return;
  input.removeAttribute("aria-invalid");
  find(input.id + "-refused").textContent = "";
}

function refuse({ fields }) {
  all("[aria-invalid]").forEach(pardon);
  const rest = [];
  for (const [name, sentence] of Object.entries(fields)) {
    const input = find(name), line = find(name + "-refused");
    if (!line) { rest.push(sentence); continue; }
    line.textContent = sentence;
    input.setAttribute("aria-invalid", "true");
  }
  say(rest.join("; "));
}

document.addEventListener("input", event => pardon(event.target));

let fading;
function say(text) {
  const notice = find("notice");
  notice.textContent = text;
  notice.hidden = !text;
  clearTimeout(fading);
  if (text) fading = setTimeout(() => { notice.hidden = true; }, 8000);
}

// ---- controls

find("fields").addEventListener("submit", event => event.preventDefault());

let sliding = 0, pending = false; // the slider moves; a request of it is due
find("slider").addEventListener("input", () => {
  if (pending) return;
  sliding = 1;
  pending = true;
  setTimeout(() => { pending = false; slid(false); }, 60);
});
find("slider").addEventListener("change", () => { sliding = 0; slid(true); });

for (const button of all("[data-opens]")) button.onclick = () => find(button.dataset.opens).showModal();

for (const button of all("[data-copy]")) button.onclick = async () => {
  const text = { link: location.href, python: shown.python, commands: shown.commands }[button.dataset.copy];
  try { await navigator.clipboard.writeText(text); button.textContent = "Copied"; } catch { button.textContent = "Select and copy"; }
  setTimeout(() => { button.textContent = "Copy"; }, 1500);
};

// ---- files

// Columns of the first part of a figure.
const columns = name => Object.fromEntries(parts(models[name].renderers[0].data_source.data));

// Lines of a table, given by its columns.
function lines(table) {
  const names = Object.keys(table), quote = value => (typeof value === "string" ? `"${value.replaceAll('"', '""')}"` : value);
  const rows = Array.from(table[names[0]], (_, n) => names.map(key => quote(table[key][n])).join(","));
  return [names.join(","), ...rows, ""].join("\n");
}

// Figure as a file, whose border is not transparent as on the page.
function picture(name, kind) {
  const style = document.documentElement.style, border = "--bk-border-fill-color";
  style.setProperty(border, "var(--paper)");
  try { return Bokeh.index.find_one(models[name]).export(kind, true); } finally { style.removeProperty(border); }
}

for (const button of all("[data-save]")) button.onclick = async () => {
  const name = find("which").value, kind = button.dataset.save;
  if (kind !== "csv") return save(name, await picture(name, kind).to_blob(), kind);
  const data = table(name);
  if (data) save(name, new Blob([lines(data)], { type: "text/csv" }), kind);
  else say("The figure is not computed yet: save it when it is.");
};

function save(name, blob, suffix) {
  const anchor = document.createElement("a");
  anchor.href = URL.createObjectURL(blob);
  anchor.download = `rocking-${name}.${suffix}`;
  anchor.click();
  setTimeout(() => URL.revokeObjectURL(anchor.href), 5000);
}

function keep(saved) {
  if (!saved) return;
  const { data } = Object.fromEntries(parts(saved));
  save("map", new Blob([data], { type: "application/x-netcdf" }), "nc");
}

// ---- dark and light

// Return a palette of one colour, in each of its opacities, in another colour.
function shades(palette, colour) {
  return palette.map(shade => colour + shade.slice(7));
}

function theme(name) {
  document.documentElement.dataset.theme = name;
  for (const model of Object.values(models)) {
    const view = Bokeh.index.find_one(model);
    view?.request_repaint?.();
  }
  const style = getComputedStyle(document.documentElement), colour = name => ({ value: style.getPropertyValue(name) });
  for (const name of ["line", "accent", "block", "edge", "soft"]) inks[name] = style.getPropertyValue(`--${name}`);
  for (const model of Object.values(models)) model.title.setv({ text_color: colour("--ink").value.trim() }, { sync: false });
  for (const { name, glyph } of Object.values(models).flatMap(model => model.renderers)) {
    if (name === "words") glyph.setv({ text_color: colour("--soft") }, { sync: false });
    if (name === "line") glyph.setv({ line_color: colour("--motion") }, { sync: false });
    if (name === "dots") glyph.setv({ fill_color: colour("--motion") }, { sync: false });
    if (name === "dense") glyph.color_mapper.setv({ palette: shades(glyph.color_mapper.palette, colour("--motion").value.trim()) }, { sync: false });
  }
  frame();
}
find("theme").onclick = () => {
  const next = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
  localStorage.setItem("theme", next);
  theme(next);
};

// ---- the block

let film = null, clock = 0, last = 0;
const inks = {}; // read once per theme, because reading a style in a frame forces a recalculation of all styles

// Set the film: angle in the units of the critical angle, drawn with a factor that makes a small angle visible.
function shoot(angle, critical, height, others) {
  let peak = 0;
  for (const value of angle) peak = Math.max(peak, Math.abs(value));
  const angles = Math.min(Math.max(0.35 / (peak * critical || 1), 1), 12), turn = Math.min(peak * critical * angles, Math.PI / 2);
  film = { angle, critical, height, angles, wide: height * Math.max(1.7, 2.2 * Math.sin(turn) + 0.3), ...others };
}

function now() {
  const { time, angle } = film;
  let low = 0, high = time.length - 1;
  while (high - low > 1) { const middle = (low + high) >> 1; if (time[middle] <= clock) low = middle; else high = middle; }
  const step = time[high] - time[low], share = step > 0 ? Math.min(Math.max((clock - time[low]) / step, 0), 1) : 0;
  return angle[low] + share * (angle[high] - angle[low]);
}

function frame() {
  const canvas = find("block"), ink = canvas.getContext("2d"), sharp = devicePixelRatio || 1, wide = canvas.clientWidth, high = canvas.clientHeight;
  if (!wide) return;
  if (canvas.width !== Math.round(wide * sharp)) canvas.width = Math.round(wide * sharp);
  if (canvas.height !== Math.round(high * sharp)) canvas.height = Math.round(high * sharp);
  ink.setTransform(sharp, 0, 0, sharp, 0, 0);
  ink.clearRect(0, 0, wide, high);
  if (!film?.time.length) return;
  const scale = Math.min((high - 34) / film.height, wide / film.wide), floor = high - 16;
  const displaced = film.displacement(clock) * film.moves * scale;
  const turn = Math.max(Math.min(now() * film.critical * film.angles, Math.PI / 2), -Math.PI / 2), half = film.width * scale / 2, tall = film.height * scale;
  ink.strokeStyle = inks.line;
  ink.lineWidth = 1;
  for (let at = wide / 2 % 14; at < wide; at += 14) { ink.beginPath(); ink.moveTo(at, floor + 9); ink.lineTo(at - 5, floor + 14); ink.stroke(); }
  ink.beginPath(); ink.moveTo(0, floor + 9); ink.lineTo(wide, floor + 9); ink.stroke();
  ink.save();
  ink.translate(wide / 2 + displaced, floor);
  ink.fillStyle = inks.line;
  const table = Math.max(tall * 0.7, half * 3);
  ink.fillRect(-table, 0, 2 * table, 9);
  ink.fillStyle = inks.accent;
  ink.beginPath(); ink.moveTo(-4, 9); ink.lineTo(4, 9); ink.lineTo(0, 2); ink.fill();
  if (film.wall) {
    const thick = 0.06 * tall;
    ink.strokeStyle = inks.soft;
    ink.strokeRect(-half - thick, -1.04 * tall, thick, 1.04 * tall);
    for (let at = 0; at > -1.04 * tall; at -= thick) { ink.beginPath(); ink.moveTo(-half - thick, at); ink.lineTo(-half, Math.max(at - thick, -1.04 * tall)); ink.stroke(); }
  }
  if (film.restrained) {
    const pivot = turn > 0 ? half : -half;
    ink.strokeStyle = inks.soft;
    ink.lineWidth = 3;
    ink.beginPath(); ink.moveTo(0, 9); ink.lineTo(pivot * (1 - Math.cos(turn)), -pivot * Math.sin(turn)); ink.stroke();
    ink.lineWidth = 1;
  }
  ink.translate(turn > 0 ? half : -half, 0);
  ink.rotate(turn);
  ink.translate(turn > 0 ? -half : half, 0);
  ink.fillStyle = inks.block;
  ink.strokeStyle = inks.edge;
  ink.fillRect(-half, -tall, 2 * half, tall);
  ink.strokeRect(-half, -tall, 2 * half, tall);
  if (film.centre) { ink.fillStyle = inks.edge; ink.beginPath(); ink.arc(film.centre[0] * scale, -film.centre[1] * scale, 4, 0, 2 * Math.PI); ink.fill(); }
  ink.restore();
}

function tick(at) {
  const passed = Math.min((at - last) / 1000, 0.1);
  last = at;
  if (playing && film?.time.length && !document.hidden) {
    const end = film.time[film.time.length - 1];
    clock += passed * film.speed;
    if (clock > end) clock = film.time[0];
    frame();
  }
  requestAnimationFrame(tick);
}
requestAnimationFrame(tick);
const label = () => { find("play").textContent = playing ? "❚❚" : "▶"; };
find("play").onclick = () => { playing = !playing; label(); };
label();
new ResizeObserver(frame).observe(find("block"));
const preferred = () => (localStorage.getItem("theme") ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light"));
theme(preferred());
