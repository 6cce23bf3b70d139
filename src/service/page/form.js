// The form of a study, made from its JSON Schema, and the study as TOML text.
//
// Every part of the form is a node: { element, read(), find(path), focus(key) }. `read` gives the value, undefined for "not given";
// `find` gives the node at a path like "parameters[0].lower" and what is left of the path where the form has no such part.

import { h, label, nice, say } from "/page/base.js";

let count = 0;
const nextId = () => `f${++count}`;
const singular = (text) => text.replace(/s$/, "");
const lower = (text) => text.charAt(0).toLowerCase() + text.slice(1);

/** Follows references; descriptions nearer to the key win. */
function resolve(root, schema) {
  const inner = schema.$ref ? root.$defs[schema.$ref.split("/").pop()] : schema.anyOf?.find((one) => one.type !== "null");
  if (!inner) return schema;
  const full = resolve(root, inner);
  const units = full.pattern && /\((.*)\)$/.exec(full.description)?.[1];
  return { ...full, ...(units && { units }), ...(schema.description && { description: schema.description }) };
}

function kindOf(root, schema) {
  if (schema.oneOf?.every((one) => "const" in one)) return "choice";
  if (schema.type === "object") return schema.properties ? "group" : "map";
  if (schema.type !== "array") return schema.type === "boolean" ? "flag" : "entry";
  const item = kindOf(root, resolve(root, schema.items));
  return item === "group" ? "list" : "lines";
}

function makeNode(root, schema, value, place) {
  const full = resolve(root, schema);
  const makers = { group: groupNode, map: mapNode, list: listNode };
  const make = makers[kindOf(root, full)] ?? leafNode;
  return make(root, full, value, place);
}

// Fields.

// Quantities are shown with "µm" and "°C" and sent as the study file has them, so that equal studies have equal hashes.
const isQuantity = (text) => /^\s*[-+.]?\d/.test(text);
const shownText = (text) => (isQuantity(text) ? nice(text) : text);
const sentText = (text) =>
  (isQuantity(text)
    ? text
        .replace(/[µμ](?=[ms])/g, "u")
        .replace("°", "deg")
        .replaceAll("²", "2")
        .replaceAll("³", "3")
    : text
  ).trim();
const numberOf = (text) => (text.trim() !== "" && Number.isFinite(Number(text)) ? Number(text) : text.trim());

/** Lines of text as a list; rows of a table are parted by commas, semicolons or tabs. */
function readLines(text, item) {
  const one = (part) => (item.type === "string" ? sentText(part) : numberOf(part));
  const lines = text.split("\n").filter((line) => line.trim() !== "");
  if (item.type === "array") return lines.map((line) => line.split(/[,;\t]/).map(numberOf));
  return lines.map(one);
}

const showLines = (value) =>
  (value ?? []).map((line) => (Array.isArray(line) ? line.join(", ") : typeof line === "string" ? shownText(line) : line)).join("\n");

function freeValue(text) {
  try {
    return JSON.parse(text);
  } catch {
    return text;
  }
}

/** Control of a leaf, and how it is read. */
function control(root, schema, value, attributes) {
  const kind = kindOf(root, schema);
  if (kind === "choice") {
    const options = schema.oneOf.map((one) => h("option", { value: one.const, selected: one.const === value }, one.const));
    const none = !schema.oneOf.some((one) => one.const === value) && h("option", { value: "" }, "– choose –");
    const element = h("select", attributes, none, options);
    return [element, () => element.value || undefined];
  }
  if (kind === "flag") {
    const element = h("input", { type: "checkbox", ...attributes, checked: value === true });
    return [element, () => element.checked];
  }
  if (kind === "lines") {
    const item = resolve(root, schema.items);
    const element = h("textarea", { rows: Math.min(12, Math.max(3, (value ?? []).length)), spellcheck: "false", ...attributes });
    element.value = showLines(value);
    return [element, () => (element.value.trim() === "" ? undefined : readLines(element.value, item))];
  }
  const numeric = schema.type === "number" || schema.type === "integer";
  const shown = value === undefined || value === null ? "" : typeof value === "string" ? shownText(value) : JSON.stringify(value);
  const long = schema.type === "string" && !schema.pattern && shown.length > 40;
  const element = long
    ? h("textarea", { rows: 2, ...attributes })
    : h("input", { type: "text", inputmode: numeric ? "decimal" : null, spellcheck: "false", ...attributes });
  element.value = shown;
  const read = numeric ? numberOf : schema.type === "string" ? sentText : freeValue;
  return [element, () => (element.value.trim() === "" ? undefined : read(element.value))];
}

function helpOf(root, schema) {
  const parts = [];
  if (schema.description) parts.push(nice(schema.description));
  if (schema.units) parts.push(`Unit: ${nice(schema.units)}.`);
  if (kindOf(root, schema) === "lines")
    parts.push(resolve(root, schema.items).type === "array" ? "One row a line, values parted by commas." : "One value a line.");
  return parts.join(" ");
}

/** A field; that of a choice says what the chosen one means. */
export function leafNode(root, schema, value, place) {
  const id = nextId();
  const help = helpOf(root, schema);
  const error = h("p", { class: "error", id: `${id}-error`, hidden: true });
  const chosen = schema.oneOf && h("span", { class: "chosen" });
  const described = `${id}-help`;
  const [input, read] = control(root, schema, value, { id, "aria-describedby": described, "aria-required": place.required });
  const tell = () => chosen?.replaceChildren(nice(schema.oneOf.find((one) => one.const === input.value)?.description ?? ""));
  tell();
  input.addEventListener("change", tell);
  const name = h("label", { for: id }, place.name, place.required && h("span", { class: "faint" }, " (needed)"));
  const element = h(
    "div",
    { class: `field ${input.type ?? ""}` },
    h("div", { class: "name" }, name, place.remove),
    input,
    error,
    h("p", { class: "help", id: described }, h("span", {}, help, " "), chosen),
  );
  const show = (text) => {
    error.textContent = nice(text);
    error.hidden = !text;
    input.setAttribute("aria-describedby", text ? `${id}-error ${described}` : described);
    text ? input.setAttribute("aria-invalid", "true") : input.removeAttribute("aria-invalid");
  };
  const node = { element, read, show, name: place.name, focus: () => input.focus() };
  node.find = () => ({ node, rest: "" });
  return node;
}

// Groups: keys of an object, entries of a map, items of a list.

function frame(place, help, ...content) {
  const id = nextId();
  const error = h("p", { class: "error", id: `${id}-error`, hidden: true });
  const heading = h(`h${Math.min(6, place.level)}`, { tabindex: "-1" }, place.name);
  const element = h(
    "fieldset",
    { "aria-describedby": help ? `${id}-help` : null },
    h("legend", {}, heading),
    place.remove,
    help && h("p", { class: "help", id: `${id}-help` }, nice(help)),
    error,
    content,
  );
  const show = (text) => {
    error.textContent = nice(text);
    error.hidden = !text;
    const parts = [text && error.id, help && `${id}-help`].filter(Boolean);
    parts.length ? element.setAttribute("aria-describedby", parts.join(" ")) : element.removeAttribute("aria-describedby");
  };
  return { element, heading, show };
}

function removeButton(name, act) {
  return h(
    "button",
    { type: "button", class: "remove", "aria-label": `Remove ${lower(name)}`, title: `Remove ${lower(name)}`, onclick: act },
    "×",
  );
}

/** Finds the part of a path among children by their keys; the longest wins, for keys may hold dots. */
function descend(node, children, path) {
  const rest = path.replace(/^\./, "");
  const fits = [...children.keys()].filter((key) => rest === key || (rest.startsWith(key) && ".[".includes(rest[key.length])));
  const key = fits.sort((a, b) => b.length - a.length)[0];
  return key === undefined ? { node, rest } : children.get(key).find(rest.slice(key.length));
}

/** The list of keys that a group does not have yet, each with its description and a button. */
function offers(root, schema, place, has, add) {
  const more = h("ul");
  const summary = h("summary");
  const element = h("details", { class: "more" }, summary, more);
  const refresh = () => {
    const absent = Object.keys(schema.properties).filter((key) => !has(key) && !isFixed(schema, key));
    element.hidden = absent.length === 0;
    summary.textContent = place.level === 1 ? `Add a section (${absent.length})` : `Add to “${place.name}” (${absent.length})`;
    more.replaceChildren(
      ...absent.map((key) =>
        h(
          "li",
          {},
          h("button", { type: "button", "data-key": key, onclick: () => add(key) }, `+ ${label(key)}`),
          h("span", { class: "help" }, nice(resolve(root, schema.properties[key]).description ?? "")),
        ),
      ),
    );
  };
  const focus = (key) => {
    const button = key && more.querySelector(`[data-key="${CSS.escape(key)}"]`);
    if (button) element.open = true;
    button?.focus();
    return Boolean(button);
  };
  return { element, refresh, focus };
}

const isFixed = (schema, key) => "const" in schema.properties[key];

function groupNode(root, schema, value, place) {
  const children = new Map();
  const keys = Object.keys(schema.properties);
  const needed = schema.required ?? [];
  const fields = h("div", { class: "fields" });
  const drop = (key) => {
    children.get(key).element.remove();
    children.delete(key);
    more.refresh();
    more.focus(key);
    say(`${label(key)} removed.`);
  };
  const put = (key, one) => {
    const name = label(key);
    const required = needed.includes(key);
    const remove = required ? null : removeButton(name, () => drop(key));
    const child = makeNode(root, schema.properties[key], one, { name, required, remove, level: place.level + 1 });
    child.element.dataset.key = key;
    children.set(key, child);
    const next = [...fields.children].find((other) => keys.indexOf(other.dataset.key) > keys.indexOf(key));
    fields.insertBefore(child.element, next ?? null);
    return child;
  };
  const add = (key) => {
    const child = put(key, startOf(root, schema.properties[key]));
    more.refresh();
    child.focus();
    say(`${label(key)} added.`);
  };
  const more = offers(root, schema, place, (key) => children.has(key), add);
  const { element, heading, show } = frame(place, schema.description, place.front, fields, more.element);
  for (const key of keys) {
    const given = value?.[key] !== undefined;
    if ((given || needed.includes(key)) && !isFixed(schema, key)) put(key, given ? value[key] : startOf(root, schema.properties[key]));
  }
  more.refresh();
  const node = { element, heading, show, children, name: place.name };
  node.read = () => {
    const one = (key) => (isFixed(schema, key) ? schema.properties[key].const : children.get(key)?.read());
    return Object.fromEntries(keys.map((key) => [key, one(key)]).filter(([, read]) => read !== undefined));
  };
  node.find = (path) => descend(node, children, path);
  node.focus = (key) => more.focus(key) || (children.size ? [...children.values()][0].focus() : heading.focus());
  return node;
}

/** What a new part begins with: the keys it needs; of small parts that name none, all without a default. */
function startOf(root, schema) {
  const full = resolve(root, schema);
  const kind = kindOf(root, full);
  if (kind === "list") return [startOf(root, full.items)];
  if (kind === "map") return { "": typeof full.additionalProperties === "object" ? startOf(root, full.additionalProperties) : "" };
  if (kind !== "group") return undefined;
  const keys = Object.keys(full.properties);
  const plain = keys.filter((key) => !/default/i.test(resolve(root, full.properties[key]).description ?? ""));
  const wanted = full.required ?? (plain.length <= 4 ? plain : plain.slice(0, 1));
  return Object.fromEntries(wanted.map((key) => [key, startOf(root, full.properties[key]) ?? null]));
}

/** Items in a row with a button to add one; `entry` makes the node of one, `fresh` the value of a new one. */
function itemsNode(place, help, entry, fresh) {
  const nodes = [];
  const items = h("div", { class: "items" });
  const one = lower(singular(place.name));
  const add = h(
    "button",
    {
      type: "button",
      onclick: () => {
        put(fresh()).focus();
        say(`${one} added.`);
      },
    },
    `+ Add ${/^[aeiou]/.test(one) ? "an" : "a"} ${one}`,
  );
  const { element, show } = frame(place, help, items, h("p", {}, add));
  const number = () => nodes.forEach((node, k) => node.number?.(k));
  const put = (value) => {
    const remove = removeButton(one, () => {
      nodes.splice(nodes.indexOf(node), 1);
      node.element.remove();
      number();
      add.focus();
      say(`${one} removed.`);
    });
    const node = entry(value, remove, nodes.length);
    nodes.push(node);
    items.append(node.element);
    number();
    return node;
  };
  return { element, show, put, nodes, name: place.name, focus: () => (nodes[0] ?? add).focus() };
}

function listNode(root, schema, value, place) {
  const name = singular(place.name);
  const entry = (one, remove, k) => {
    const node = groupNode(root, { ...resolve(root, schema.items), description: "" }, one, {
      name: `${name} ${k + 1}`,
      remove,
      level: place.level + 1,
    });
    node.number = (at) => {
      node.element.querySelector("legend > *").textContent = node.name = `${name} ${at + 1}`;
    };
    return node;
  };
  const node = itemsNode(place, schema.description, entry, () => startOf(root, schema.items));
  for (const one of value ?? []) node.put(one);
  node.read = () => node.nodes.map((item) => item.read());
  node.find = (path) => {
    const [, index, rest] = /^\[(\d+)\](.*)$/.exec(path) ?? [];
    return node.nodes[index]?.find(rest) ?? { node, rest: path };
  };
  return node;
}

function mapNode(root, schema, value, place) {
  const inner = resolve(root, typeof schema.additionalProperties === "object" ? schema.additionalProperties : {});
  const simple = kindOf(root, inner) !== "group";
  const entry = ([key, one], remove) => {
    const id = nextId();
    const input = h("input", { type: "text", id, spellcheck: "false", value: key });
    const front = h("div", { class: "field" }, h("div", { class: "name" }, h("label", { for: id }, simple ? "Key" : "Name")), input);
    const title = () => `${singular(place.name)} ${input.value}`;
    const at = { name: title(), remove, level: place.level + 1 };
    const node = makeNode(root, { ...inner, description: "" }, one, simple ? { name: "Value" } : { ...at, front });
    const outer = simple ? frame(at, "", h("div", { class: "fields" }, front, node.element)) : node;
    input.addEventListener("input", () => {
      outer.heading.textContent = title();
    });
    const within = node.focus;
    return Object.assign(node, {
      element: outer.element,
      key: () => input.value.trim(),
      focus: (rest) => (rest ? within(rest) : input.focus()),
    });
  };
  const node = itemsNode(place, schema.description, entry, () => Object.entries(startOf(root, schema))[0]);
  for (const one of Object.entries(value ?? {})) node.put(one);
  node.read = () => Object.fromEntries(node.nodes.map((item) => [item.key(), item.read() ?? ""]));
  node.find = (path) => descend(node, new Map(node.nodes.map((item) => [item.key(), item])), path);
  return node;
}

/** The form of a study. */
export function studyForm(schema, study) {
  const top = groupNode(schema, { ...schema, description: "" }, study, { name: "Study", level: 1 });
  return { ...top, locate: (path) => top.find(path.replace(/^study\.?/, "")) };
}

// TOML.

const KEY = String.raw`(?:[\w-]+|"[^"]*"|'[^']*')`;
const DOTTED = `${KEY}(?:\\s*\\.\\s*${KEY})*`;
const HEADER = new RegExp(`^\\s*(\\[\\[?)\\s*(${DOTTED})\\s*\\]\\]?\\s*(?:#.*)?$`);
const PAIR = new RegExp(`^\\s*(${DOTTED})\\s*=`);
const partsOf = (dotted) => dotted.match(new RegExp(KEY, "g")).map((part) => part.replace(/^["']|["']$/g, ""));
const join = (path, part) => (path ? `${path}.${part}` : part);

/** Line of every table and key in a TOML text, by the path that the service uses: `parameters[0].lower`. */
export function tomlLines(text) {
  const lines = new Map();
  const last = new Map();
  let table = "";
  const place = (parts) =>
    parts.reduce((path, part) => {
      const key = join(path, part);
      return last.has(key) ? `${key}[${last.get(key)}]` : key;
    }, "");
  text.split("\n").forEach((line, k) => {
    const [, brackets, header] = HEADER.exec(line) ?? [];
    const pair = header === undefined && PAIR.exec(line);
    if (header !== undefined && brackets === "[[") {
      const parts = partsOf(header);
      const key = join(place(parts.slice(0, -1)), parts.at(-1));
      last.set(key, (last.get(key) ?? -1) + 1);
      table = `${key}[${last.get(key)}]`;
    } else if (header !== undefined) table = place(partsOf(header));
    if (header !== undefined) lines.set(table, { line: k + 1, whole: false });
    if (pair) lines.set(partsOf(pair[1]).reduce(join, table), { line: k + 1, whole: true });
  });
  return lines;
}

/** A study without what the service filled in: only the keys that the text gives. */
export function onlyGiven(value, lines, path = "") {
  if (typeof value !== "object" || value === null || lines.get(path)?.whole) return value;
  const given = (key) => [...lines.keys()].some((one) => one === key || (one.startsWith(key) && ".[".includes(one[key.length])));
  if (Array.isArray(value)) return value.map((one, k) => onlyGiven(one, lines, `${path}[${k}]`));
  const kept = Object.entries(value).filter(([key]) => given(join(path, key)));
  return Object.fromEntries(kept.map(([key, one]) => [key, onlyGiven(one, lines, join(path, key))]));
}

const isTable = (value) => typeof value === "object" && value !== null && !Array.isArray(value);
const isTables = (value) => Array.isArray(value) && value.length > 0 && value.every(isTable);
const tomlKey = (key) => (/^[\w-]+$/.test(key) ? key : JSON.stringify(key));

function tomlValue(value) {
  if (Array.isArray(value)) return `[${value.map(tomlValue).join(", ")}]`;
  if (isTable(value))
    return `{ ${Object.entries(value)
      .map(([key, one]) => `${tomlKey(key)} = ${tomlValue(one)}`)
      .join(", ")} }`;
  return JSON.stringify(value);
}

/** A study as TOML text. */
export function toToml(table, path = "") {
  const entries = Object.entries(table);
  const lines = entries.filter(([, one]) => !isTable(one) && !isTables(one)).map(([key, one]) => `${tomlKey(key)} = ${tomlValue(one)}\n`);
  const tables = entries
    .filter(([, one]) => isTable(one) || isTables(one))
    .map(([key, one]) => {
      const name = join(path, tomlKey(key));
      if (isTables(one)) return one.map((item) => `\n[[${name}]]\n${toToml(item, name)}`).join("");
      return `\n[${name}]\n${toToml(one, name)}`;
    });
  return lines.join("") + tables.join("");
}
