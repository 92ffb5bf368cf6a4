// A browser's tab that counts what must not happen: errors on the console, requests of others, breaches of the page's rules.
import { until } from "./wait.mjs";

export function newFigures() {
  return { console_errors: 0, csp_violations: 0, third_party_requests: 0, moves_without_press: 0 };
}

const kPatience_ms = 120000;  // on a busy machine; nothing is judged by it

const kMoves = new Set(["job.start", "stage.move", "stage.home", "stage.jog", "stage.autofocus"]);

// options: language, theme, token, viewport; scale: pixels of the screen a CSS pixel; clock_ms: this browser's clock is wrong by
// so much; mayMove: a test that moves the stage on purpose; mayFail: one that cuts the line; mayWarn: what a test itself has
// the browser warn of
export async function openTab(browser, station, figures, { language = "en", theme = "light", token = station.token,
  viewport = { width: 1280, height: 1024 }, scale = 1, clock_ms = 0, mayMove = false, mayFail = false, mayWarn = null } = {}) {
  const context = await browser.newContext({ viewport, deviceScaleFactor: scale, colorScheme: theme, locale: language === "de" ? "de-DE" : "en-GB" });
  if (clock_ms !== 0) await context.addInitScript(setClock, clock_ms);
  const tell = (what, text) => console.error(`${what}: ${text}`);
  await context.exposeBinding("tellBreach", (_, text) => {
    ++figures.csp_violations;
    tell("breach of the content security policy", text);
  });
  await context.addInitScript(([given, settings]) => {
    if (self.origin === "null") return;  // an empty page may keep nothing
    if (given) sessionStorage.setItem("fvd.token", given);
    for (const [key, value] of Object.entries(settings)) localStorage.setItem(key, value);
    addEventListener("securitypolicyviolation", (event) => void window.tellBreach(`${event.violatedDirective} ${event.blockedURI}`));
  }, [token, { "fvd.language": language, "fvd.theme": theme }]);
  context.setDefaultTimeout(kPatience_ms);
  const page = await context.newPage();
  const failed = (text) => {
    if (mayFail && /Failed to load resource|ERR_/.test(text) || mayWarn?.test(text)) return;
    ++figures.console_errors;
    tell("console", `${page.url()}: ${text}`);
  };
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) failed(`${message.text()} ${message.location().url ?? ""}`);
  });
  page.on("pageerror", (error) => failed(String(error.stack ?? error)));
  page.on("request", (request) => {
    const url = request.url();
    if (/^(blob|data|about):/.test(url)) return;
    if (new URL(url).origin !== new URL(station.url).origin) {
      ++figures.third_party_requests;
      tell("request of another host", url);
    }
    if (!mayMove && request.method() === "POST" && kMoves.has(methodOf(request))) {
      ++figures.moves_without_press;
      tell("moved without a press", request.postData());
    }
  });
  return { context, page, close: () => context.close() };
}

// In the page: whoever asks for the time without saying which gets a wrong one.
function setClock(ahead_ms) {
  const { now } = Date;
  globalThis.Date = class extends Date {
    constructor(...given) {
      if (given.length > 0) super(...given);
      else super(now() + ahead_ms);
    }
    static now() {
      return now() + ahead_ms;
    }
  };
}

export function methodOf(request) {
  try {
    return JSON.parse(request.postData() ?? "{}").method ?? "";
  } catch {
    return "";
  }
}

// The page is drawn, has its events, and does not change any more (a live picture is let change).
export async function settled(page) {
  await page.waitForSelector("main > *");
  await page.evaluate(() => new Promise((tell) => {
    const quiet_ms = 250;
    const longest = setTimeout(done, 2500);
    let timer = setTimeout(done, quiet_ms);
    const observer = new MutationObserver(() => {
      clearTimeout(timer);
      timer = setTimeout(done, quiet_ms);
    });
    observer.observe(document.body, { subtree: true, childList: true, attributes: true, characterData: true, attributeFilter: ["class", "hidden", "disabled"] });
    function done() {
      clearTimeout(longest);
      clearTimeout(timer);
      observer.disconnect();
      tell();
    }
  }));
}

export async function visit(page, station, path, { isOnline = true } = {}) {
  await page.goto(new URL(path, station.url).href, { waitUntil: "load" });
  await page.waitForSelector("main > *");
  if (isOnline) await until(`the events of ${path}`, () => page.evaluate(() => document.querySelector("header .link") === null), kPatience_ms);
  await settled(page);
}
