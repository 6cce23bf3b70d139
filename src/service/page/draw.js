// Answers as drawings and tables: convergence, orbits in the clearance circle, a design and its limits, two designs side by side.
// Nothing here talks to the service.

import { h, label, nice, num, quantity, s } from "/page/base.js";

// Charts.

function steps(low, high, wanted) {
  const raw = (high - low || 1) / wanted;
  const power = 10 ** Math.floor(Math.log10(raw));
  return power * [1, 2, 5, 10].find((factor) => factor * power >= raw * 0.999);
}

function linearTicks(low, high, wanted = 4) {
  const step = steps(low, high, wanted);
  const first = Math.floor(low / step + 1e-9);
  const last = Math.ceil(high / step - 1e-9);
  return Array.from({ length: last - first + 1 }, (_, k) => Number(((first + k) * step).toPrecision(12)));
}

function logTicks(low, high) {
  const first = Math.floor(Math.log10(low));
  const last = Math.max(first + 1, Math.ceil(Math.log10(high)));
  const every = Math.ceil((last - first) / 6);
  return Array.from({ length: Math.ceil((last - first) / every) + 1 }, (_, k) => first + k * every);
}

const power = (exponent) => [`10`, s("tspan", { dy: -4, "font-size": 9 }, String(exponent).replace("-", "−"))];

const marks = {
  round: (x, y, name) => s("circle", { class: `mark ${name}`, cx: x, cy: y, r: 3.5 }),
  square: (x, y, name) => s("rect", { class: `mark ${name}`, x: x - 3.2, y: y - 3.2, width: 6.4, height: 6.4 }),
};

function legend(series, x, y) {
  let at = x;
  return series.map(({ name, look, mark }) => {
    const part = s(
      "g",
      { transform: `translate(${at} ${y})` },
      s("line", { class: `line ${look}`, x1: 0, x2: 26, y1: -4, y2: -4 }),
      marks[mark](13, -4, look),
      s("text", { x: 32 }, name),
    );
    at += 46 + 6.6 * name.length;
    return part;
  });
}

/** Runs of points: a new one starts where x goes back or a value is missing. */
function runs(points, good) {
  const all = [[]];
  for (const point of points) {
    if (point === null) all.push([]);
    else if (good(point)) all.at(-1).push(point);
  }
  return all.filter((run) => run.length);
}

/** A chart of lines: { title, x, y, log, series: [{ name, look, mark, points }], level: { at, name } }. */
export function chart({ title, x, y, log, series, level }) {
  const [left, right, top, bottom, width, height] = [52, 368, 34, 202, 380, 250];
  const good = ([, value]) => Number.isFinite(value) && (!log || value > 0);
  const points = series.flatMap((one) => runs(one.points, good).flat());
  const ys = [...points.map(([, value]) => value), ...(level ? [level.at] : [])];
  const [low, high] = ys.length ? [Math.min(...ys), Math.max(...ys)] : [log ? 0.1 : 0, 1];
  const pad = high > low ? 0 : Math.abs(high) * 0.05 || 1;
  const ticks = log ? logTicks(low, high) : linearTicks(low - pad, high + pad);
  const xTicks = linearTicks(0, Math.max(1, ...points.map(([at]) => at)), 6).filter(Number.isInteger);
  const px = (at) => left + ((right - left) * at) / xTicks.at(-1);
  const py = (value) => bottom - ((bottom - top) * ((log ? Math.log10(value) : value) - ticks[0])) / (ticks.at(-1) - ticks[0]);
  const tickY = (tick) => py(log ? 10 ** tick : tick);
  const grid = [
    ticks.map((tick) => [
      s("line", { class: "grid", x1: left, x2: right, y1: tickY(tick), y2: tickY(tick) }),
      s("text", { x: left - 6, y: tickY(tick) + 4, "text-anchor": "end" }, log ? power(tick) : num(tick, 6)),
    ]),
    xTicks.map((tick) => [
      s("line", { class: "grid", x1: px(tick), x2: px(tick), y1: top, y2: bottom }),
      s("text", { x: px(tick), y: bottom + 16, "text-anchor": "middle" }, tick),
    ]),
  ];
  const lines = series.map((one) =>
    runs(one.points, good).map((run) => [
      s("polyline", { class: `line ${one.look}`, points: run.map(([at, value]) => `${px(at)},${py(value)}`).join(" ") }),
      run.length <= 60 && run.map(([at, value]) => marks[one.mark](px(at), py(value), one.look)),
    ]),
  );
  const limit = level && [
    s("line", { class: "level", x1: left, x2: right, y1: py(level.at), y2: py(level.at) }),
    s("text", { x: right, y: py(level.at) - 4, "text-anchor": "end" }, level.name),
  ];
  return s(
    "svg",
    { class: "chart", viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": title },
    grid,
    s("path", { class: "axis", d: `M${left},${top}V${bottom}H${right}` }),
    limit,
    lines,
    s("text", { x: 4, y: 14, class: "strong" }, y),
    series.length > 1 && legend(series, 150, 14),
    s("text", { x: (left + right) / 2, y: height - 12, "text-anchor": "middle" }, x),
  );
}

/** Convergence of a search from its accepted designs; searches that follow each other stand in a row. */
export function convergence(history, tolerance) {
  const row = (key) =>
    history.flatMap((one, k) => {
      const point = [k, one[key] ?? NaN];
      return k > 0 && one.iteration <= history[k - 1].iteration ? [null, point] : [point];
    });
  const last = history.at(-1) ?? {};
  const x = "accepted designs after the start";
  const lookA = { look: "a", mark: "round" };
  const lookB = { look: "b", mark: "square" };
  const charts = [
    chart({
      title: `Objective over accepted designs, now ${quantity(last.objective_w, "W", 5)}`,
      x,
      y: "objective, W",
      series: [{ name: "objective", ...lookA, points: row("objective_w") }],
    }),
    chart({
      title: `KKT residual, now ${num(last.kkt, 2)}, and violation of limits, now ${num(last.violation, 2)}, over accepted designs, logarithmic`,
      x,
      y: "residuals, –",
      log: true,
      level: tolerance && { at: tolerance, name: "tolerance" },
      series: [
        { name: "KKT", ...lookA, points: row("kkt") },
        { name: "violation", ...lookB, points: row("violation") },
      ],
    }),
  ];
  if (history.some((one) => Number.isFinite(one.min_film_thickness_um)))
    charts.push(
      chart({
        title: `Smallest film thickness over accepted designs, now ${quantity(last.min_film_thickness_um, "um")}`,
        x,
        y: "smallest film, µm",
        series: [{ name: "film", ...lookA, points: row("min_film_thickness_um") }],
      }),
    );
  return h("div", { class: "charts" }, charts);
}

/** Orbits by bearing and operating point, from orbit.csv. */
export function orbitsOf(csv) {
  const [head, ...rows] = csv
    .trim()
    .split("\n")
    .map((line) => line.trim().split(","));
  const column = (name) => head.indexOf(name);
  const [angle, x, y] = ["crank_angle_deg", "eccentricity_x_ratio", "eccentricity_y_ratio"].map(column);
  const orbits = new Map();
  for (const row of rows) {
    const key = `${row[column("bearing")]}, ${row[column("operating_point")]}`;
    if (!orbits.has(key)) orbits.set(key, []);
    orbits.get(key).push([Number(row[angle]), Number(row[x]), Number(row[y])]);
  }
  return orbits;
}

/** Orbits in one clearance circle: [{ name, look, mark, points: [[crank angle, x, y]] }]. */
export function orbitChart(title, series) {
  const [middle, radius] = [225, 160];
  const px = (x) => middle + radius * x;
  const py = (y) => middle - radius * y;
  const ticks = [-1, -0.5, 0, 0.5, 1];
  const grid = ticks.map((tick) => [
    s("line", { class: "grid", x1: px(tick), x2: px(tick), y1: 55, y2: 395 }),
    s("line", { class: "grid", y1: py(tick), y2: py(tick), x1: 55, x2: 395 }),
    s("text", { x: px(tick), y: 412, "text-anchor": "middle" }, num(tick)),
    s("text", { x: 50, y: py(tick) + 4, "text-anchor": "end" }, num(tick)),
  ]);
  const told = [];
  const free = (x, y) => told.every(([u, v]) => Math.hypot(u - x, v - y) > 0.16) && told.push([x, y]);
  const words = (angle, x, y) => s("text", { class: "small", x: px(x), y: py(y) + 4, "text-anchor": "middle" }, `${Math.round(angle)}°`);
  const lines = series.map((one) => {
    const closed = [...one.points, one.points[0]];
    const quarters = one.points.filter(([angle], k) => k === 0 || Math.floor(angle / 90) > Math.floor(one.points[k - 1][0] / 90));
    return [
      s("polyline", { class: `line ${one.look}`, points: closed.map(([, x, y]) => `${px(x).toFixed(1)},${py(y).toFixed(1)}`).join(" ") }),
      quarters.map(([angle, x, y]) => {
        const inside = 1 - 0.14 / (Math.hypot(x, y) || 1);
        return [
          marks[one.mark](px(x), py(y), one.look),
          one.labels && free(x * inside, y * inside) && words(angle, x * inside, y * inside),
        ];
      }),
    ];
  });
  return s(
    "svg",
    { class: "chart orbit", viewBox: "0 0 430 464", role: "img", "aria-label": title },
    grid,
    s("circle", { class: "clearance", cx: middle, cy: middle, r: radius }),
    lines,
    legend(series, 55, 24),
    s("text", { x: middle, y: 434, "text-anchor": "middle" }, "eccentricity ratio along 0°, –"),
    s("text", { transform: `translate(14 ${middle}) rotate(-90)`, "text-anchor": "middle" }, "eccentricity ratio along 90°, –"),
    s("text", { x: middle, y: 455, "text-anchor": "middle", class: "small" }, "dashed circle: clearance; marks: every 90° of the crank"),
  );
}

// Tables.

/** A table that scrolls by itself where the screen is narrow; cells that begin a row are headers. */
export function table(caption, head, rows) {
  const cell = (one, k) =>
    k === 0
      ? h("th", { scope: "row" }, typeof one === "string" ? one.split(/(?<=[._])/).flatMap((part) => [part, h("wbr")]) : one)
      : h("td", { class: typeof one === "string" && /^[−–+\d]/.test(one) ? "number" : null }, one);
  return h(
    "div",
    { class: "scroll", tabindex: "0", role: "region", "aria-label": caption },
    h(
      "table",
      {},
      h("caption", {}, caption),
      h(
        "thead",
        {},
        h(
          "tr",
          {},
          head.map((one) => h("th", { scope: "col" }, one)),
        ),
      ),
      h(
        "tbody",
        {},
        rows.map((row) => h("tr", {}, row.map(cell))),
      ),
    ),
  );
}

function box({ lower, upper, start, value }) {
  const at = (one) => 8 + (104 * (one - lower)) / (upper - lower || 1);
  return s(
    "svg",
    { class: "box", viewBox: "0 0 120 16", width: 120, height: 16, "aria-hidden": "true" },
    s("path", { class: "axis", d: "M8,3V13M8,8H112M112,3V13" }),
    s("circle", { class: "start", cx: at(start), cy: 8, r: 4 }),
    s("circle", { class: "mark a", cx: at(value), cy: 8, r: 4 }),
  );
}

const bounds = { upper: "at upper bound", lower: "at lower bound" };

function designTable(design) {
  return table(
    "Parameters",
    ["Parameter", "Start", "Design", "Lower bound", "Upper bound", "In its box (○ start, ● design)", "1 % of the box more does"],
    design.map((one) => [
      one.name,
      quantity(one.start, one.unit, 5),
      h(
        "span",
        {},
        h("strong", {}, quantity(one.value, one.unit, 5)),
        bounds[one.at_bound] && h("span", { class: "tag" }, bounds[one.at_bound]),
      ),
      quantity(one.lower, one.unit, 5),
      quantity(one.upper, one.unit, 5),
      box(one),
      one.effect_w_per_percent === null ? "–" : quantity(one.effect_w_per_percent, "W"),
    ]),
  );
}

const signs = { "at least": "≥", "at most": "≤", equals: "=" };

function stateOf(limit) {
  if (!limit.met) return h("span", { class: "state failed" }, "✕ broken");
  return limit.active
    ? h("span", { class: "state running" }, "● met, holds the design back")
    : h("span", { class: "state succeeded" }, "✓ met");
}

const limitName = (one) => (one.sum ? one.sum : `${one.quantity.replaceAll("-", " ")}, ${one.bearing}, ${one.operating_point}`);
const limitText = (one) => `${signs[one.sense] ?? one.sense} ${quantity(one.limit, one.unit)}`;
const price = (one) =>
  one.price_w_per_unit === null || one.price_w_per_unit === undefined ? "–" : `${num(one.price_w_per_unit)} W per ${nice(one.unit)}`;
const limitsOf = (report) => [...(report.constraints ?? []), ...(report.linear_constraints ?? [])];

function limitsTable(report) {
  const value = (one) => quantity(one.exact_value ?? one.value, one.unit);
  return table(
    "Limits; the price is the loss that one unit of relaxation would save",
    ["Quantity", "Limit", "Value", "State", "Price"],
    limitsOf(report).map((one) => [nice(limitName(one)), limitText(one), value(one), stateOf(one), price(one)]),
  );
}

function lossTable(report) {
  const cells = (loss) => [num(loss?.total_w), num(loss?.contact_w, 3)];
  return table(
    "Mean friction loss by bearing and operating point, W",
    ["Bearing, operating point", "Weight", "Start", "of it contact", "Design", "of it contact"],
    report.objective.operating_points.map((one) => [
      `${one.bearing}${one.count > 1 ? ` (${one.count} of it)` : ""}, ${one.operating_point}`,
      num(one.weight),
      ...cells(one.start),
      ...cells(one.optimum),
    ]),
  );
}

const tile = (name, value, more) => h("div", { class: "tile" }, h("dt", {}, name), h("dd", {}, value, more && h("small", {}, more)));
export const tiles = (...all) =>
  h(
    "dl",
    { class: "tiles" },
    all.filter(Boolean).map((one) => tile(...one)),
  );

const losses = (report) => [report.objective.start?.total_w, report.objective.optimum?.total_w];

/** Whether an answer is a report on a design. */
export const isReport = (answer) => String(answer?.schema_version).startsWith("stribeck-report/");

/** The answer of a report: what came out, then parameters, limits and losses. */
export function answer(report) {
  const [start, found] = losses(report);
  const { saving_percent: saving, start_violation: violation } = report.objective;
  const taken = report.choices?.taken ?? [];
  const simulated = report.outcome.status === "simulated";
  const start_note = violation > 0 ? `breaks a limit by ${num(100 * violation, 3)} %` : "";
  return [
    h("p", { class: "lead" }, h("strong", {}, `${label(report.outcome.status.replaceAll("-", "_"))}. `), nice(report.outcome.advice)),
    tiles(
      ["Friction loss of the start", quantity(start, "W"), start_note],
      !simulated && ["Friction loss of the design", quantity(found, "W")],
      !simulated && [
        "Saving",
        saving === null ? "–" : `${num(saving, 3)} %`,
        report.kkt?.residual ? `KKT residual ${num(report.kkt.residual, 2)}` : "",
      ],
      ...taken.map((one) => [one.name, one.taken]),
    ),
    h("p", { class: "faint" }, `Objective: ${nice(report.objective.quantity)}.`),
    designTable(report.design),
    limitsOf(report).length > 0 && limitsTable(report),
    lossTable(report),
    report.outcome.refused?.length > 0 && [
      h("p", {}, "Simulations that were refused:"),
      h(
        "ul",
        {},
        report.outcome.refused.map((one) => h("li", {}, nice(one))),
      ),
    ],
  ];
}

function pairs(a, b, keyOf) {
  const keys = [...new Set([...a, ...b].map(keyOf))];
  return keys.map((key) => [key, a.find((one) => keyOf(one) === key), b.find((one) => keyOf(one) === key)]);
}

const difference = (a, b, unit) => (Number.isFinite(a) && Number.isFinite(b) ? `${b > a ? "+" : ""}${quantity(b - a, unit, 3)}` : "–");
const orNone = (one, text) => (one ? text(one) : "–");

/** Two reports side by side. */
export function comparison(a, b) {
  const [startA, foundA] = losses(a);
  const [startB, foundB] = losses(b);
  const row = (name, x, y, unit) => [name, quantity(x, unit), quantity(y, unit), difference(x, y, unit)];
  const head = (first) => [first, "A", "B", "B less A"];
  const limit = (one) =>
    h(
      "span",
      {},
      quantity(one.exact_value ?? one.value, one.unit),
      h("br"),
      stateOf(one),
      h("br"),
      h("small", {}, `${limitText(one)}; price ${price(one)}`),
    );
  return [
    table("Loss", head("Quantity"), [
      row("Friction loss of the start", startA, startB, "W"),
      row("Friction loss of the design", foundA, foundB, "W"),
      row("Saving", a.objective.saving_percent, b.objective.saving_percent, "%"),
    ]),
    table(
      "Parameters of the designs",
      head("Parameter"),
      pairs(a.design, b.design, (one) => one.name).map(([name, x, y]) => [
        name,
        orNone(x, (one) => quantity(one.value, one.unit, 5)),
        orNone(y, (one) => quantity(one.value, one.unit, 5)),
        x?.unit === y?.unit ? difference(x?.value, y?.value, x?.unit ?? "") : "–",
      ]),
    ),
    table(
      "Limits",
      ["Quantity", "A", "B"],
      pairs(limitsOf(a), limitsOf(b), limitName).map(([name, x, y]) => [nice(name), orNone(x, limit), orNone(y, limit)]),
    ),
  ];
}
