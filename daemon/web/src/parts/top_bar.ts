// What is on every page: where one is, who one is, whether the daemon answers, whether it is simulated.
import { type Language, t, setLanguage, useLanguage } from "../i18n/i18n.ts";
import { html } from "../lib/html.ts";
import { place } from "../lib/router.ts";
import { useStore } from "../lib/store.ts";
import { type Theme, setTheme, theme } from "../lib/theme.ts";
import { link, topics } from "../live/live.ts";
import { RpcError, tokenWasRefused } from "../rpc/rpc.ts";
import { addressFault } from "../rpc/token_in_address.ts";
import { messageOf } from "./message_of.ts";
import { SessionButton } from "./session_button.ts";

const kPages = [
  ["/", "nav.run"],
  ["/jobs", "nav.history"],
  ["/recipes", "nav.recipes"],
  ["/setup", "nav.setup"],
] as const;

const isAt = (path: string, page: string): boolean => (page === "/" ? path === "/" : path.startsWith(page));

export function TopBar() {
  const language = useLanguage();
  const { path } = useStore(place);
  const { status } = useStore(link);
  const { state } = useStore(topics);
  const colours = useStore(theme);
  const isRefused = useStore(tokenWasRefused);
  const fault = useStore(addressFault);
  return html`<header class="top">
    <a class="skip" href="#main" onClick=${(event: Event) => {
      event.preventDefault();
      document.getElementById("main")?.focus();
    }}>${t("skip")}</a>
    ${state?.simulated && html`<p class="ribbon">${t("simulated")}</p>`}
    ${status !== "open" && html`<p class="link" role="alert">${t(status === "lost" ? "link.lost" : "link.never")}</p>`}
    ${isRefused && html`<p class="refused" role="alert">${t("session.refused")}</p>`}
    ${fault !== null && html`<p class="refused" role="alert">${t("session.address_refused", {
      why: fault instanceof RpcError && fault.code === 401 ? t("session.wrong") : messageOf(fault),
    })}</p>`}
    <div class="bar">
      <nav aria-label=${t("nav.label")}>
        ${kPages.map(([page, key]) => html`<a href=${page} aria-current=${isAt(path, page) ? "page" : undefined}>${t(key)}</a>`)}
      </nav>
      <span class="options">
        <label><span class="hidden">${t("language.label")}</span>
          <select value=${language} onChange=${(event: Event) => void setLanguage((event.target as HTMLSelectElement).value as Language)}>
            <option value="en" lang="en">English</option>
            <option value="de" lang="de">Deutsch</option>
          </select>
        </label>
        <label><span class="hidden">${t("theme.label")}</span>
          <select value=${colours} onChange=${(event: Event) => setTheme((event.target as HTMLSelectElement).value as Theme)}>
            <option value="auto">${t("theme.auto")}</option>
            <option value="light">${t("theme.light")}</option>
            <option value="dark">${t("theme.dark")}</option>
          </select>
        </label>
        <${SessionButton}/>
      </span>
    </div>
  </header>`;
}
