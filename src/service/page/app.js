// The views of the page and the way between them: #/new, #/new/ID, #/jobs, #/jobs/ID, #/compare/A/B.

import {
  Problem,
  action,
  blobUrl,
  forgetKey,
  getJson,
  getText,
  h,
  label,
  loading,
  nice,
  num,
  problemBox,
  quantity,
  releaseUrls,
  request,
  save,
  say,
  showKey,
  span,
  time,
} from "/page/base.js";
import { answer, comparison, convergence, isReport, orbitChart, orbitsOf, tiles } from "/page/draw.js";
import { leafNode, onlyGiven, studyForm, toToml, tomlLines } from "/page/form.js";

const main = document.getElementById("main");
const jobPath = (id, rest = "") => `/v1/jobs/${encodeURIComponent(id)}${rest}`;

const STATES = {
  queued: ["○", "waiting"],
  running: ["◐", "running"],
  succeeded: ["✓", "finished"],
  failed: ["✕", "failed"],
  cancelled: ["–", "cancelled"],
};
const isOver = (job) => !["queued", "running"].includes(job.state);
const hasAnswer = (job) => ["succeeded", "cancelled"].includes(job.state);

const DESIGNS = ["study", "operational", "running-in", "simulation"];
const KINDS = {
  study: "Whatever the study asks for: a design, a table, a comparison of gradient engines.",
  operational: "The design with the least loss in service.",
  "running-in": "The design with the least loss while it runs in; the study says running_in.minimise.",
  simulation: "The start design simulated, nothing searched.",
  gradient: "The gradient at the start design.",
  check: "The study with all its defaults.",
};

/** Ends of a search that are as wanted; all others are pointed out. */
const GOOD = ["converged", "almost-converged", "complete", "simulated", "cancelled"];

function stateTag(job) {
  const [sign, word] = STATES[job.state] ?? ["?", job.state];
  const asked = job.cancel_requested && !isOver(job) ? ", asked to end" : "";
  const outcome = job.outcome && !["complete", "cancelled"].includes(job.outcome) ? `: ${job.outcome.replaceAll("-", " ")}` : "";
  const warned = job.state === "succeeded" && !GOOD.includes(job.outcome ?? "complete");
  return h("span", { class: `state ${warned ? "warned" : job.state}` }, `${warned ? "!" : sign} ${word}${asked}${outcome}`);
}

function field(name, input, help) {
  input.id ||= `field-${name.toLowerCase().replaceAll(/\W+/g, "-")}`;
  if (help) input.setAttribute("aria-describedby", `${input.id}-help`);
  return h(
    "div",
    { class: "field" },
    h("label", { for: input.id }, name),
    input,
    help && h("p", { class: "help", id: `${input.id}-help` }, help),
  );
}

// A new job.

/** The study that is being written: it is still there when one comes back. */
let draft = null;

async function newView(from) {
  if (draft && (from === undefined || from === draft.from)) return draft.content;
  const [schema, text] = await Promise.all([
    getJson("/v1/schema/study"),
    getText(from ? jobPath(from, "/study?format=toml") : "/v1/example"),
  ]);
  const { study } = await getJson("/v1/check", { json: { study: text } });
  draft = { from, content: submission(schema, text, onlyGiven(study, tomlLines(text))) };
  return draft.content;
}

/** Form and TOML text of one study; the one that was changed last fills the other when the tab changes. */
function editor(schema, text, study) {
  const area = h("textarea", { id: "toml", class: "code", rows: 30, spellcheck: "false", "aria-describedby": "toml-help toml-errors" });
  const errors = h("ul", { id: "toml-errors", class: "error" });
  const place = h("div", { class: "study" });
  const sections = h("nav", { class: "sections", "aria-label": "Sections of the study" });
  const one = { tab: "form", area, errors, place, sections, changed: false };
  const list = () =>
    sections.replaceChildren(
      h("p", {}, "Sections"),
      h(
        "ul",
        {},
        [...one.form.element.querySelector(".fields").children].map(({ dataset: { key } }) =>
          h(
            "li",
            {},
            h(
              "button",
              {
                type: "button",
                class: "link",
                onclick: () => {
                  const node = one.form.children.get(key);
                  node.element.scrollIntoView();
                  node.focus();
                },
              },
              label(key),
            ),
          ),
        ),
      ),
    );
  one.fill = (value) => {
    one.form = studyForm(schema, value);
    place.replaceChildren(one.form.element);
    new MutationObserver(list).observe(one.form.element.querySelector(".fields"), { childList: true });
    list();
    one.changed = false;
  };
  one.study = () => (one.tab === "form" ? one.form.read() : area.value);
  one.switchTo = async (tab) => {
    if (tab === "toml" && one.changed) area.value = toToml(one.form.read());
    if (tab === "form" && one.changed) {
      const checked = await getJson("/v1/check", { json: { study: area.value } });
      one.fill(onlyGiven(checked.study, tomlLines(area.value)));
    }
    one.tab = tab;
    one.changed = false;
  };
  for (const element of [place, area])
    for (const event of ["input", "click"])
      element.addEventListener(event, (e) => {
        if (event === "input" || e.target.matches("button")) one.changed = true;
      });
  area.value = text;
  one.fill(study);
  return one;
}

function tabs(names, open) {
  const buttons = names.map(([key, name]) =>
    h("button", { type: "button", role: "tab", id: `tab-${key}`, "aria-controls": `panel-${key}`, onclick: () => open(key) }, name),
  );
  const list = h("div", { role: "tablist", "aria-label": "How to write the study" }, buttons);
  list.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    const next = buttons[(buttons.indexOf(document.activeElement) + step + buttons.length) % buttons.length];
    next.focus();
    next.click();
  });
  const mark = (key) =>
    names.forEach(([name], k) => {
      buttons[k].setAttribute("aria-selected", String(name === key));
      buttons[k].tabIndex = name === key ? 0 : -1;
    });
  return { list, mark };
}

const placeName = (path) =>
  path
    .replace(/^study\.?/, "")
    .replace(/\[(\d+)\]/g, (_, k) => ` ${Number(k) + 1}`)
    .split(".")
    .filter(Boolean)
    .map(label)
    .join(" › ") || "Study";

function focusLine(area, line) {
  const lines = area.value.split("\n");
  const start = lines.slice(0, line - 1).join("\n").length + (line > 1 ? 1 : 0);
  area.focus();
  area.setSelectionRange(start, start + (lines[line - 1] ?? "").length);
  area.scrollTop = (area.scrollHeight / lines.length) * Math.max(0, line - 5);
}

/** Line of the text that a mistake is about: told by it, or that of the nearest part the text gives. */
function lineOf(text, { path, message }) {
  const told = /\(line (\d+)\)/.exec(message);
  if (told) return Number(told[1]);
  const lines = tomlLines(text);
  for (let at = path.replace(/^study\.?/, ""); at; at = at.replace(/(\.[^.[]*|\[\d+\]|^[^.[]*)$/, ""))
    if (lines.has(at)) return lines.get(at).line;
  return 1;
}

/** Shows all mistakes, at their fields and in a list with links to them. */
function mistakes(error, one, kind) {
  const items = [];
  const told = new Map();
  for (const mistake of error?.document?.errors ?? []) {
    const { path, message } = mistake;
    const inForm = one.tab === "form" && path.startsWith("study");
    const found = path === "kind" ? { node: kind, rest: "" } : inForm ? one.form.locate(path) : null;
    const line = !found && path.startsWith("study") ? lineOf(one.area.value, mistake) : null;
    if (found) told.set(found.node, [...(told.get(found.node) ?? []), found.rest ? `${placeName(found.rest)}: ${message}` : message]);
    const go = () => (found ? found.node.focus(found.rest) : focusLine(one.area, line ?? 1));
    items.push([`${line ? `Line ${line}: ` : ""}${placeName(path)}`, nice(message), go]);
  }
  for (const node of one.wrong ?? []) node.show("");
  one.wrong = [...told.keys()];
  for (const [node, messages] of told) node.show(messages.join("; "));
  one.errors.replaceChildren(...(one.tab === "toml" ? items.map(([name, message]) => h("li", {}, `${name}: ${message}`)) : []));
  one.area.setAttribute("aria-invalid", String(one.tab === "toml" && items.length > 0));
  const links = items.map(([name, message, go]) =>
    h(
      "li",
      {},
      h(
        "a",
        {
          href: "#main",
          onclick: (event) => {
            event.preventDefault();
            go();
          },
        },
        name,
      ),
      `: ${message}`,
    ),
  );
  return h(
    "div",
    { class: "problem", tabindex: "-1" },
    h("h2", {}, links.length === 1 ? "One mistake" : `${links.length} mistakes`),
    h("ul", {}, links),
  );
}

const TABS = [
  ["form", "Form"],
  ["toml", "TOML text"],
];
const TOML_HELP =
  "Paste or edit a study file. It is sent as it stands, with its comments. The form is filled from it when you go back to the form; " +
  "a text made from the form has no comments.";

function panelsOf(one) {
  const attributes = (key) => ({ role: "tabpanel", id: `panel-${key}`, "aria-labelledby": `tab-${key}` });
  const help = h("p", { class: "help", id: "toml-help" }, TOML_HELP);
  return {
    form: h("div", { ...attributes("form"), class: "with-sections" }, one.sections, one.place),
    toml: h("div", attributes("toml"), h("label", { for: "toml" }, "Study as TOML"), help, one.area, one.errors),
  };
}

/** What the buttons do with the study that is written. */
function deeds(one, kind, status) {
  let sent = {};
  const check = async () => {
    const { study_hash: hash } = await getJson("/v1/check", { json: { study: one.study() } });
    status.textContent = `No mistakes. Hash of the study: ${hash.slice(0, 12)}`;
  };
  const submit = async () => {
    const json = { kind: kind.read(), study: one.study() };
    const text = JSON.stringify(json);
    // The same word when it is sent again after the connection was lost: one job, not two.
    if (sent.text !== text) sent = { text, word: `page-${Date.now()}-${Math.random()}` };
    const job = await getJson("/v1/jobs", { json, headers: { "Idempotency-Key": sent.word } });
    sent = {};
    location.hash = `#/jobs/${job.id}`;
  };
  const example = () => {
    draft = null;
    location.hash === "#/new" ? route() : (location.hash = "#/new");
  };
  return { check, submit, example };
}

function submission(schema, text, study) {
  const one = editor(schema, text, study);
  const kinds = Object.entries(KINDS).map(([name, description]) => ({ const: name, description }));
  const kind = leafNode({}, { oneOf: kinds }, "study", { name: "Kind of job" });
  const summary = h("div");
  const status = h("p", { role: "status", class: "faint" });
  const panels = panelsOf(one);
  const attempt = (act) => async () => {
    mistakes(null, one, kind);
    summary.replaceChildren();
    status.textContent = "";
    try {
      await act();
    } catch (error) {
      const list = error.document?.errors?.length;
      summary.replaceChildren(list ? mistakes(error, one, kind) : problemBox(error));
      summary.scrollIntoView();
      if (list) summary.firstChild.focus();
    }
  };
  const show = (key) => {
    for (const [name, panel] of Object.entries(panels)) panel.hidden = name !== key;
    bar.mark(key);
  };
  const turn = async (key) => {
    await one.switchTo(key);
    show(key);
  };
  const bar = tabs(TABS, (key) => attempt(() => turn(key))());
  show("form");
  const { check, submit, example } = deeds(one, kind, status);
  const lead =
    "A study says which bearings, under which load, varied how, judged by what. The worked example is filled in; it takes seconds.";
  const buttons = [
    action("Submit the job", { class: "main" }, attempt(submit)),
    action("Check only", {}, attempt(check)),
    action("Start over from the example", { class: "quiet" }, example),
  ];
  const head = [h("h1", { tabindex: "-1" }, "New job"), h("p", { class: "lead" }, lead)];
  return [...head, summary, kind.element, bar.list, panels.form, panels.toml, h("div", { class: "bar" }, buttons, status)];
}

// The list of jobs.

const list = { state: "", title: "", pages: [""], picked: new Set() };

function jobActions(job, after) {
  const name = `“${job.title}” of ${job.created_at}`;
  if (!isOver(job))
    return action("Cancel", { "aria-label": `Cancel ${name}`, "data-key": `cancel ${job.id}` }, async () => {
      await request(jobPath(job.id, "/cancel"), { method: "POST" });
      say("The job was asked to end.");
      await after(false);
    });
  return action("Delete", { "aria-label": `Delete ${name}`, class: "quiet", "data-key": `delete ${job.id}` }, async () => {
    if (!confirm(`Delete the job “${job.title}” with its result?`)) return;
    await request(jobPath(job.id), { method: "DELETE" });
    list.picked.delete(job.id);
    say("The job is deleted.");
    await after(true);
  });
}

const took = (job) => (job.started_at && job.finished_at ? span((new Date(job.finished_at) - new Date(job.started_at)) / 1000) : "–");

function jobsTable(jobs, picked, refresh) {
  const pick = (job) =>
    hasAnswer(job) &&
    DESIGNS.includes(job.kind) &&
    h("input", {
      type: "checkbox",
      "data-key": `pick ${job.id}`,
      "aria-label": `Compare “${job.title}” of ${job.created_at}`,
      checked: list.picked.has(job.id),
      onchange: (event) => picked(job.id, event.target.checked),
    });
  const head = ["Compare", "State", "Title", "Kind", "Submitted", "Took", "Actions"];
  const rows = jobs.map((job) => [
    pick(job),
    stateTag(job),
    h("a", { href: `#/jobs/${job.id}`, "data-key": job.id }, job.title || "(no title)"),
    job.kind,
    time(job.created_at),
    took(job),
    jobActions(job, refresh),
  ]);
  // The roles stay where the style makes cards of the rows.
  return h(
    "table",
    { class: "jobs", role: "table" },
    h("caption", { class: "unseen" }, "Jobs, newest first"),
    h(
      "thead",
      { role: "rowgroup" },
      h(
        "tr",
        { role: "row" },
        head.map((name) => h("th", { scope: "col", role: "columnheader" }, name)),
      ),
    ),
    h(
      "tbody",
      { role: "rowgroup" },
      rows.map((cells) =>
        h(
          "tr",
          { role: "row" },
          cells.map((cell, k) => h("td", { role: "cell", "data-name": head[k] }, cell)),
        ),
      ),
    ),
  );
}

/** State and title that the list is narrowed to. */
function filters(changed) {
  const option = ([key, [, word]]) => h("option", { value: key, selected: key === list.state }, word);
  const state = h("select", {}, h("option", { value: "" }, "any"), Object.entries(STATES).map(option));
  const title = h("input", { type: "search", value: list.title });
  const read = () => {
    list.state = state.value;
    list.title = title.value.trim();
    changed();
  };
  state.addEventListener("change", read);
  title.addEventListener("input", read);
  return h("div", { class: "filters" }, field("State", state), field("Text in the title", title));
}

/** Which two jobs are to be compared. */
function picks(place) {
  const element = h("p", { class: "faint" });
  const tell = () => {
    const [a, b] = list.picked;
    const link = () => h("a", { class: "button main", href: `#/compare/${a}/${b}` }, "Compare the two chosen jobs");
    element.replaceChildren(b ? link() : "Choose two jobs with a design to compare them.");
  };
  const pick = (id, on) => {
    on ? list.picked.add(id) : list.picked.delete(id);
    while (list.picked.size > 2) list.picked.delete([...list.picked][0]);
    for (const box of place.querySelectorAll("input[data-key]")) box.checked = list.picked.has(box.dataset.key.slice(5));
    tell();
  };
  tell();
  return { element, pick };
}

function jobsPage() {
  const query = new URLSearchParams({ limit: 20 });
  const wanted = { state: list.state, title: list.title, after: list.pages.at(-1) };
  for (const [name, value] of Object.entries(wanted)) if (value) query.set(name, value);
  return `/v1/jobs?${query}`;
}

function jobsView(signal) {
  const place = h("div");
  const { element: compare, pick } = picks(place);
  let shown = "";
  let asked = 0;
  const turn = async (pages) => {
    list.pages = pages;
    await refresh();
    say(`${place.querySelectorAll("tbody tr").length} jobs on page ${pages.length}.`, true);
  };
  const draw = ({ jobs, next }) => {
    const older = next && action("Older", { "data-key": "older" }, () => turn([...list.pages, next]));
    const newer = list.pages.length > 1 && action("Newer", { "data-key": "newer" }, () => turn(list.pages.slice(0, -1)));
    const key = place.contains(document.activeElement) && document.activeElement.dataset.key;
    const none = h("p", {}, list.state || list.title ? "No job fits." : ["No jobs yet. ", h("a", { href: "#/new" }, "Submit one")]);
    const pager = h("p", { class: "buttons" }, newer, " ", older, ` Page ${list.pages.length}`);
    place.replaceChildren(jobs.length ? jobsTable(jobs, pick, refresh) : none, pager);
    if (key) (place.querySelector(`[data-key="${key}"]`) ?? place.querySelector("a, button"))?.focus();
  };
  const refresh = async () => {
    const mine = ++asked;
    try {
      const page = await getJson(jobsPage(), { signal });
      if (mine !== asked) return;
      if (shown !== JSON.stringify(page)) draw(page);
      shown = JSON.stringify(page);
    } catch (error) {
      if (error.name === "AbortError") return;
      shown = "";
      place.replaceChildren(problemBox(error, refresh));
    }
  };
  const again = setInterval(() => !document.hidden && !place.querySelector(".problem") && refresh(), 4000);
  signal.addEventListener("abort", () => clearInterval(again));
  refresh();
  return [h("h1", { tabindex: "-1" }, "Jobs"), filters(() => turn([""])), compare, place];
}

// One job.

async function* eventsOf(body) {
  const reader = body.pipeThrough(new TextDecoderStream()).getReader();
  let text = "";
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return;
    const parts = (text + value).split(/\r?\n\r?\n/);
    text = parts.pop();
    for (const part of parts) {
      const fields = Object.fromEntries(
        part
          .split(/\r?\n/)
          .map((line) => line.split(/: ?(.*)/s))
          .filter(([name]) => name),
      );
      if (fields.data) yield { id: fields.id, type: fields.event ?? "message", data: JSON.parse(fields.data) };
    }
  }
}

/** Follows a job to its end; where the connection is lost it goes on from the last event. */
async function follow(id, signal, heard, lost) {
  let last = null;
  for (let wait = 1; !signal.aborted; wait = Math.min(2 * wait, 30)) {
    try {
      const response = await request(jobPath(id, "/events"), { signal, headers: last ? { "Last-Event-ID": last } : {} });
      for await (const event of eventsOf(response.body)) {
        last = event.id ?? last;
        wait = 1;
        if (event.type === "end") return event.data;
        if (event.type !== "problem") heard(event);
      }
    } catch (error) {
      if (signal.aborted) break;
      if (error.document?.status < 500 && error.document.status !== 429) throw error;
    }
    lost(wait);
    await new Promise((resolve) => setTimeout(resolve, 1000 * wait));
  }
  throw new DOMException("left", "AbortError");
}

function liveTiles(now) {
  return tiles(
    ["Stage", now.stage ?? "waits for a worker"],
    ["Accepted designs", num(now.iteration)],
    ["Objective", quantity(now.objective_w, "W", 5)],
    ["Violation of limits", num(now.violation, 2)],
    ["KKT residual", num(now.kkt, 2)],
    ["Smallest film", quantity(now.min_film_thickness_um, "um")],
    ["Simulations", num(now.simulations, 9)],
    ["Time left, estimated", span(now.seconds_left)],
  );
}

function livePanel(job, signal, ended) {
  const numbers = h("div", {}, liveTiles(job.progress ?? {}));
  const drawing = h("div");
  const status = h("p", { class: "faint" }, "Numbers come as the job goes on.");
  const history = [];
  let stage = null;
  const heard = ({ type, data }) => {
    status.textContent =
      history.length || type === "iteration"
        ? "Connected."
        : "Connected. Numbers come with the first accepted design, where the job is one search.";
    numbers.replaceChildren(liveTiles(data));
    if (type === "iteration") {
      history.push(data);
      drawing.replaceChildren(convergence(history, null));
    }
    if (data.stage !== stage) say(`Stage: ${data.stage}.`);
    else if (type === "iteration")
      say(`Design ${data.iteration}: objective ${quantity(data.objective_w, "W")}, KKT residual ${num(data.kkt, 2)}.`, true);
    stage = data.stage;
  };
  const lost = (wait) => {
    status.textContent = `The connection is lost; trying again in ${wait} s.`;
  };
  follow(job.id, signal, heard, lost).then(ended, (error) => {
    if (error.name !== "AbortError") status.replaceWith(problemBox(error, route));
  });
  return h("section", { "aria-labelledby": "live-title" }, h("h2", { id: "live-title" }, "Now"), numbers, drawing, status);
}

const CYCLE = {
  orbit: [
    "Orbit in the clearance circle",
    (o) =>
      `smallest film ${quantity(o.min_film_thickness_um.value, "um")} at ${num(o.min_film_thickness_um.crank_angle_deg)}° of the crank`,
  ],
  "pressure-map": [
    "Film pressure over the bearing surface",
    (o) => `largest ${quantity(o.max_film_pressure_mpa.value, "MPa")} at ${num(o.max_film_pressure_mpa.crank_angle_deg)}° of the crank`,
  ],
  "sensitivity-maps-shell": [
    "Sensitivity of the loss to the gap, by place on the shell",
    () => "blue: more gap saves power; orange: it costs power",
  ],
  "sensitivity-maps-journal": [
    "Sensitivity of the loss to the gap, by place on the journal",
    () => "blue: more gap saves power; orange: it costs power",
  ],
};
const MORE = {
  film: "Smallest film thickness over the cycle",
  loss: "Friction loss over the cycle",
  pressure: "Largest film pressure over the cycle",
  contact: "Contact pressure over the cycle",
  load: "Load over the cycle",
  "fill-map": "Fill of the gap with oil over the bearing surface",
};

function figure(id, name, caption, alt) {
  return h(
    "figure",
    {},
    loading(caption, async () => h("img", { src: await blobUrl(jobPath(id, `/files/${name}`)), alt })),
    h("figcaption", {}, caption),
  );
}

/** A figure of a cycle, its words made from the report. */
function cycleFigure(id, name, report) {
  const [, kind, number] = /^(.*?)-?(\d*)\.svg$/.exec(name);
  const cycle = !kind.startsWith("running-in") && report.orbit?.[number - 1];
  const [title, facts] = CYCLE[kind] ?? [MORE[kind] ?? label(kind.replaceAll("-", "_"))];
  const where = cycle ? `: ${cycle.bearing}, ${cycle.operating_point}` : number && `, ${number}`;
  return figure(id, name, title + where, `${title}${where}${cycle && facts ? `; ${facts(cycle)}` : ""}.`);
}

/** Details that are loaded when they are opened first. */
function lazy(summary, load) {
  const place = h("div");
  return h(
    "details",
    {
      class: "fold",
      ontoggle: () => {
        if (!place.hasChildNodes()) place.append(...[load()].flat());
      },
    },
    h("summary", {}, summary),
    place,
  );
}

function figures(id, files, report) {
  const names = files.map((file) => file.name).filter((name) => name.endsWith(".svg") && name !== "convergence.svg");
  const rank = (name) => Object.keys(CYCLE).indexOf(name.replace(/-\d+\.svg$/, ""));
  const first = names
    .filter((name) => rank(name) >= 0)
    .sort((a, b) => parseInt(a.match(/\d+/)) - parseInt(b.match(/\d+/)) || rank(a) - rank(b));
  const rest = names.filter((name) => rank(name) < 0);
  const grid = (some) =>
    h(
      "div",
      { class: "figures" },
      some.map((name) => cycleFigure(id, name, report)),
    );
  if (!names.length) return null;
  return h(
    "section",
    {},
    h("h2", {}, "Figures"),
    grid(first.slice(0, 8)),
    first.length > 8 && lazy(`Other cycles (${first.length - 8} figures)`, () => grid(first.slice(8))),
    rest.length > 0 && lazy(`More figures (${rest.length})`, () => grid(rest)),
  );
}

function fullReport(id, unfold) {
  const load = () =>
    loading("the report", async () => h("iframe", { src: await blobUrl(jobPath(id, "/report")), sandbox: "", title: "Full report" }));
  const open = async (button) => {
    const url = await blobUrl(jobPath(id, "/report"));
    if (!window.open(url, "_blank"))
      button.after(" ", h("a", { href: url, target: "_blank" }, "The browser held the tab back: open it here"));
  };
  return h(
    "section",
    {},
    h("h2", {}, "Full report"),
    h("p", {}, action("Open the report in a new tab", {}, open)),
    unfold ? load() : lazy("Show it here", load),
  );
}

function downloads(id, files) {
  const row = (name, path, size) =>
    h(
      "li",
      {},
      action(`Download ${name}`, { class: "link" }, async () => save(await blobUrl(jobPath(id, path)), name)),
      h("span", { class: "faint" }, ` ${size}`),
    );
  const size = (file) => (file.characters < 1e4 ? `${num(file.characters / 1000, 2)} kB` : `${Math.round(file.characters / 1000)} kB`);
  const all = files.map((file) => row(file.name, `/files/${encodeURIComponent(file.name)}`, size(file)));
  if (!files.some((file) => file.name === "study.toml")) all.push(row("study.toml", "/study?format=toml", ""));
  return h("section", {}, h("h2", {}, "Files"), h("ul", { class: "downloads" }, all));
}

async function result(job) {
  const [found, { files }] = await Promise.all([getJson(jobPath(job.id, "/result")), getJson(jobPath(job.id, "/files"))]);
  const report = isReport(found) ? found : {};
  const page = files.some((file) => file.name === "report.html");
  const other = !isReport(found);
  const text = JSON.stringify(found, null, 2);
  const json = () => [
    h(
      "p",
      {},
      action("Download the answer as JSON", {}, () => save(URL.createObjectURL(new Blob([text])), `${job.kind}.json`)),
    ),
    h("pre", { tabindex: "0", class: "code", role: "region", "aria-label": "Answer as JSON" }, text),
  ];
  return [
    other && page && fullReport(job.id, true),
    h("section", {}, h("h2", {}, "Answer"), other ? json() : answer(found)),
    figures(job.id, files, report),
    report.history?.length > 1 && h("section", {}, h("h2", {}, "Convergence"), convergence(report.history, report.kkt.tolerance)),
    !other && page && fullReport(job.id),
    downloads(job.id, files),
    !other && loading("other jobs", () => comparable(job)),
  ].filter(Boolean);
}

async function comparable(job) {
  const { jobs } = await getJson("/v1/jobs?limit=100&state=succeeded");
  const others = jobs.filter((one) => one.id !== job.id && DESIGNS.includes(one.kind));
  if (!others.length) return [];
  const select = h(
    "select",
    {},
    others.map((one) => h("option", { value: one.id }, `${one.title}, ${one.kind}, `, time(one.created_at).textContent)),
  );
  return h(
    "div",
    { class: "filters" },
    field("Compare with", select),
    action("Compare", {}, () => {
      location.hash = `#/compare/${job.id}/${select.value}`;
    }),
  );
}

async function jobView(signal, id) {
  let job = await getJson(jobPath(id), { signal });
  const head = h("div");
  const body = h("div");
  const after = async (gone) => {
    if (gone) location.hash = "#/jobs";
    else draw((job = await getJson(jobPath(id), { signal })));
  };
  const draw = () => {
    const seen = job.attempts > 1 && `, begun ${job.attempts} times`;
    const held = head.contains(document.activeElement);
    head.replaceChildren(
      h(
        "p",
        { class: "facts" },
        stateTag(job),
        " Kind: ",
        job.kind,
        ". Submitted ",
        time(job.created_at),
        job.finished_at && `. Took ${took(job)}`,
        seen,
        ".",
      ),
      h(
        "p",
        { class: "buttons" },
        h("a", { class: "button", href: `#/new/${id}` }, "New job from this study"),
        " ",
        jobActions(job, after),
      ),
    );
    if (held) main.querySelector("h1").focus();
  };
  const finish = () => {
    draw();
    const problem = job.problem && problemBox(new Problem({ title: "The job failed", ...job.problem }));
    const found = hasAnswer(job) && loading("the result", () => result(job));
    body.replaceChildren(...[problem, found].filter(Boolean));
  };
  draw();
  if (isOver(job)) finish();
  else
    body.append(
      livePanel(job, signal, (ended) => {
        job = ended;
        say(`The job has ended: ${stateTag(job).textContent.slice(2)}.`);
        finish();
      }),
    );
  return [h("h1", { tabindex: "-1" }, job.title || "Job"), head, body];
}

// Two jobs.

async function loadForComparison(id) {
  const [job, report, { files }] = await Promise.all([
    getJson(jobPath(id)),
    getJson(jobPath(id, "/result")),
    getJson(jobPath(id, "/files")),
  ]);
  if (!isReport(report))
    throw new Problem({
      title: "Only reports on designs can be compared",
      detail: `The answer of “${job.title}” is of another kind (${job.kind}).`,
    });
  const names = files.map((file) => file.name);
  return {
    id,
    job,
    report,
    names,
    orbits: names.includes("orbit.csv") ? orbitsOf(await getText(jobPath(id, "/files/orbit.csv"))) : new Map(),
  };
}

/** A list to choose from above what was chosen; only what was chosen where there is no choice. */
function chooser(name, keys, show) {
  const place = h("div", {}, show(keys[0]));
  const select = h(
    "select",
    { onchange: () => place.replaceChildren(...[show(select.value)].flat()) },
    keys.map((key) => h("option", {}, key)),
  );
  return [keys.length > 1 && field(name, select), place];
}

async function compareView(signal, a, b) {
  const [one, two] = await Promise.all([a, b].map(loadForComparison));
  const link = (name, { id, job }) =>
    h(
      "li",
      {},
      h("strong", {}, `${name}: `),
      h("a", { href: `#/jobs/${id}` }, job.title),
      `, ${job.kind}, `,
      time(job.created_at),
      " ",
      stateTag(job),
    );
  const orbits = [...one.orbits.keys()].filter((key) => two.orbits.has(key));
  const orbit = (key) =>
    orbitChart(`Orbits of both designs in one clearance circle: ${key}`, [
      { name: "A", look: "a", mark: "round", labels: true, points: one.orbits.get(key) },
      { name: "B", look: "b", mark: "square", points: two.orbits.get(key) },
    ]);
  const maps = one.names.filter((name) => /map.*\.svg$/.test(name) && two.names.includes(name));
  const pair = (name) =>
    h(
      "div",
      { class: "figures" },
      [
        ["A", one],
        ["B", two],
      ].map(([letter, { id, report }]) => h("div", {}, h("h3", {}, letter), cycleFigure(id, name, report))),
    );
  maps.sort((x, y) => y.startsWith("pressure") - x.startsWith("pressure"));
  return [
    h("h1", { tabindex: "-1" }, "Two designs side by side"),
    h("ul", {}, link("A", one), link("B", two)),
    h("section", {}, h("h2", {}, "Numbers"), comparison(one.report, two.report)),
    h(
      "section",
      {},
      h("h2", {}, "Orbits"),
      orbits.length
        ? chooser("Bearing and operating point", orbits, orbit)
        : h("p", {}, "The two jobs have no bearing and operating point of the same name."),
    ),
    maps.length > 0 &&
      h(
        "section",
        {},
        h("h2", {}, "Maps"),
        h("p", { class: "faint" }, "Each map has a colour scale of its own."),
        chooser("Map", maps, pair),
      ),
  ].filter(Boolean);
}

// The way between the views.

let leave = new AbortController();

function viewOf([view, ...rest], signal) {
  if (view === "jobs") return rest[0] ? jobView(signal, rest[0]) : jobsView(signal);
  if (view === "compare" && rest.length === 2) return compareView(signal, ...rest);
  return newView(rest[0]);
}

async function route() {
  leave.abort();
  leave = new AbortController();
  const { signal } = leave;
  const parts = location.hash.replace(/^#\/?/, "").split("/").filter(Boolean);
  for (const link of document.querySelectorAll("nav [data-view]"))
    link.dataset.view === (parts[0] ?? "new") ? link.setAttribute("aria-current", "page") : link.removeAttribute("aria-current");
  main.replaceChildren(h("p", { class: "faint" }, "Loading …"));
  releaseUrls();
  try {
    const content = await viewOf(parts, signal);
    if (signal.aborted) return;
    main.replaceChildren(...content);
  } catch (error) {
    if (signal.aborted) return;
    main.replaceChildren(
      h("h1", { tabindex: "-1" }, "This cannot be shown"),
      problemBox(error, route),
      h("p", {}, h("a", { href: "#/jobs" }, "To the list of jobs")),
    );
  }
  const title = main.querySelector("h1");
  document.title = `${title.textContent} – stribeck`;
  if (route.before !== undefined) {
    title.focus();
    scrollTo(0, 0);
  }
  route.before = location.hash;
}

addEventListener("hashchange", route);
document.getElementById("skip").addEventListener("click", (event) => {
  event.preventDefault();
  main.focus();
});
document.getElementById("forget").addEventListener("click", () => {
  forgetKey();
  say("The key is forgotten.");
  route();
});
showKey();
route();
