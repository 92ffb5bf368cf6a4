// Which page is shown: paths of the address, so that every view has a link and the browser's buttons work.
import { createStore } from "./store.ts";

export interface Place {
  path: string;
  query: URLSearchParams;
}

const here = (): Place => ({ path: location.pathname, query: new URLSearchParams(location.search) });

export const place = createStore<Place>(here());

export function go(address: string, options: { replace?: boolean } = {}): void {
  if (options.replace) history.replaceState(null, "", address);
  else history.pushState(null, "", address);
  place.set(here());
  // A new page begins at its top; where one was on a page before, the browser knows for its Back button.
  if (!options.replace) scrollTo(0, 0);
}

export function followLinks(): void {
  addEventListener("popstate", () => place.set(here()));
  document.addEventListener("click", (event) => {
    if (event.defaultPrevented || event.button !== 0 || event.ctrlKey || event.metaKey || event.shiftKey) return;
    const link = (event.target as Element | null)?.closest?.("a[href]");
    if (!(link instanceof HTMLAnchorElement) || link.origin !== location.origin) return;
    if (link.target || link.hasAttribute("download") || link.pathname.startsWith("/api/")) return;
    event.preventDefault();
    go(link.pathname + link.search);
  });
}

// The parts of a path that a pattern names: match("/jobs/:id", "/jobs/7") is { id: "7" }.
export function match(pattern: string, path: string): Record<string, string> | null {
  const wanted = pattern.split("/");
  const given = path.split("/");
  if (wanted.length !== given.length) return null;
  const found: Record<string, string> = {};
  for (let i = 0; i < wanted.length; ++i) {
    const name = wanted[i] ?? "";
    const part = given[i] ?? "";
    if (name.startsWith(":")) {
      try {
        found[name.slice(1)] = decodeURIComponent(part);
      } catch {
        return null;  // not what this page writes
      }
    } else if (name !== part) {
      return null;
    }
  }
  return found;
}
