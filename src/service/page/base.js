// What every view needs: elements, numbers and units as text, requests to the service, messages and downloads.

const SVG = "http://www.w3.org/2000/svg";

function fill(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes ?? {})) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (value !== null && value !== undefined && value !== false) element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

/** An HTML element. */
export const h = (tag, attributes, ...children) => fill(document.createElement(tag), attributes, children);

/** An SVG element. */
export const s = (tag, attributes, ...children) => fill(document.createElementNS(SVG, tag), attributes, children);

/** Units as they are read: "um" becomes "µm", "degC" becomes "°C". */
export function nice(text) {
  return String(text)
    .replace(/(?<![A-Za-z])um(?![A-Za-z])/g, "µm")
    .replace(/(?<![A-Za-z])degC(?![A-Za-z])/g, "°C")
    .replace(/(?<![A-Za-z])(mm|cm|m)([23])(?![A-Za-z0-9])/g, (_, unit, power) => unit + (power === "2" ? "²" : "³"));
}

/** A number with so many significant digits. */
export function num(value, digits = 4) {
  if (typeof value !== "number" || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text = size < 1e-3 || size >= 1e6 ? value.toExponential(1) : String(Number(value.toPrecision(digits)));
  return text.replaceAll("-", "−");
}

/** A number with its unit. */
export const quantity = (value, unit, digits) => (Number.isFinite(value) ? `${num(value, digits)}\u00a0${nice(unit)}` : "–");

/** A point in time, in the time zone of the reader. */
export function time(text) {
  if (!text) return "–";
  const at = new Date(text);
  const two = (n) => String(n).padStart(2, "0");
  const day = `${at.getFullYear()}-${two(at.getMonth() + 1)}-${two(at.getDate())}`;
  return h("time", { datetime: text }, `${day} ${two(at.getHours())}:${two(at.getMinutes())}:${two(at.getSeconds())}`);
}

/** A duration in seconds. */
export function span(seconds) {
  if (typeof seconds !== "number" || !Number.isFinite(seconds)) return "–";
  if (seconds < 10) return `${num(seconds, 2)}\u00a0s`;
  if (seconds < 120) return `${Math.round(seconds)}\u00a0s`;
  return seconds < 7200 ? `${Math.round(seconds / 60)}\u00a0min` : `${num(seconds / 3600, 2)}\u00a0h`;
}

/** Key of the study as a label: "diametral_clearance" becomes "Diametral clearance". */
export function label(key) {
  const words = key.replaceAll("_", " ").replace(/\b(\d+)c\b/, "$1 °C");
  return words.charAt(0).toUpperCase() + words.slice(1);
}

/** What went wrong, as the service tells it (RFC 9457) or as this page sees it. */
export class Problem extends Error {
  constructor(document) {
    super(document.title);
    this.document = document;
  }
}

const store = { get: () => sessionStorage.getItem("stribeck-key"), set: (key) => sessionStorage.setItem("stribeck-key", key) };
let asking = null;

/** Takes the key back. */
export function forgetKey() {
  sessionStorage.removeItem("stribeck-key");
  showKey();
}

/** Shows whether a key is in use. */
export function showKey() {
  document.getElementById("forget").hidden = !store.get();
}

function askKey(wrong) {
  asking ??= new Promise((resolve) => {
    const dialog = document.getElementById("key");
    const field = document.getElementById("key-field");
    document.getElementById("key-wrong").hidden = !wrong;
    field.value = dialog.returnValue = "";
    dialog.addEventListener(
      "close",
      () => {
        asking = null;
        const key = dialog.returnValue === "use" ? field.value.trim() : "";
        if (key) store.set(key);
        showKey();
        resolve(Boolean(key));
      },
      { once: true },
    );
    dialog.showModal();
  });
  return asking;
}

async function problemOf(response) {
  const title = `The service answered ${response.status} ${response.statusText}`.trim();
  try {
    const document = await response.json();
    return new Problem({ title, status: response.status, ...document });
  } catch {
    return new Problem({ title, status: response.status });
  }
}

/** A request; asks for a key where one is needed, throws a Problem where there is no answer. */
export async function request(path, { json, headers = {}, ...options } = {}) {
  if (json !== undefined) {
    options = { method: "POST", body: JSON.stringify(json), ...options };
    headers = { "Content-Type": "application/json", ...headers };
  }
  const key = store.get();
  let response;
  try {
    response = await fetch(path, { ...options, headers: key ? { ...headers, Authorization: `Bearer ${key}` } : headers });
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new Problem({ title: "The service does not answer", detail: "Is it running, and is the network there?", offline: true });
  }
  if (response.status === 401) {
    // Another request may have brought a key meanwhile.
    const again = store.get() !== key || (await askKey(Boolean(key)));
    if (again) return request(path, { json, headers, ...options });
  }
  if (!response.ok) throw await problemOf(response);
  return response;
}

/** The answer as an object. */
export const getJson = async (path, options) => (await request(path, options)).json();

/** The answer as text. */
export const getText = async (path, options) => (await request(path, options)).text();

const urls = [];

/** The answer as an address that images, frames and links can use until the view changes. */
export async function blobUrl(path) {
  const response = await request(path);
  const type = response.headers.get("Content-Type") ?? "";
  const url = URL.createObjectURL(new Blob([await response.arrayBuffer()], { type }));
  urls.push(url);
  return url;
}

/** Gives the memory of all such addresses back. */
export function releaseUrls() {
  for (const url of urls.splice(0)) URL.revokeObjectURL(url);
}

/** A message about what went wrong, with a way to try again. */
export function problemBox(error, retry) {
  const {
    title,
    detail,
    errors = [],
    retry_after_s: wait,
  } = error instanceof Problem ? error.document : { title: "This page failed", detail: String(error) };
  return h(
    "div",
    { class: "problem", role: "alert" },
    h("p", {}, h("strong", {}, nice(title))),
    detail && h("p", {}, nice(detail)),
    errors.length > 0 &&
      h(
        "ul",
        {},
        errors.map((e) => h("li", {}, h("code", {}, e.path), ": ", nice(e.message))),
      ),
    wait && h("p", {}, `Try again in ${span(wait)}.`),
    retry && h("p", {}, h("button", { type: "button", onclick: retry }, "Try again")),
  );
}

/** A place that fills itself: says that it loads, then shows what came or what went wrong. */
export function loading(what, load) {
  const place = h("div", { class: "place" });
  const run = async () => {
    place.replaceChildren(h("p", { class: "faint" }, `Loading ${what} …`));
    try {
      place.replaceChildren(...[await load()].flat());
    } catch (error) {
      if (error.name !== "AbortError") place.replaceChildren(problemBox(error, run));
    }
  };
  run();
  return place;
}

/** Runs what a button is for; it cannot be pressed twice meanwhile, and tells what went wrong beside it. */
export function action(text, attributes, act) {
  const button = h("button", { type: "button", ...attributes }, text);
  let busy = false;
  button.addEventListener("click", async () => {
    if (busy) return;
    busy = true;
    button.setAttribute("aria-disabled", "true");
    if (button.nextElementSibling?.matches(".problem")) button.nextElementSibling.remove();
    try {
      await act(button);
    } catch (error) {
      button.after(problemBox(error));
    }
    busy = false;
    button.removeAttribute("aria-disabled");
  });
  return button;
}

/** Saves something as a file. */
export function save(url, name) {
  const link = h("a", { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
}

const live = { last: 0, timer: 0 };

/** Tells readers who cannot see the page; words that may wait are told every ten seconds at most, the latest only. */
export function say(text, mayWait = false) {
  clearTimeout(live.timer);
  const tell = () => {
    live.last = Date.now();
    document.getElementById("live").textContent = text;
  };
  const rest = mayWait ? live.last + 10_000 - Date.now() : 0;
  if (rest > 0) live.timer = setTimeout(tell, rest);
  else tell();
}
