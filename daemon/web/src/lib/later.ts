// A component whose script is fetched when it is first shown.
import { type FunctionComponent, h } from "preact";
import { useEffect, useState } from "preact/hooks";
import { t } from "../i18n/i18n.ts";
import { html } from "./html.ts";

export function later<P extends object>(load: () => Promise<FunctionComponent<P>>): FunctionComponent<P> {
  let known: FunctionComponent<P> | null = null;
  return function Later(props: P) {
    const [, setDrawn] = useState(0);
    const [isGone, setIsGone] = useState(false);
    useEffect(() => {
      if (known) return undefined;
      let left = false;
      load().then((component) => {
        known = component;
        if (!left) setDrawn(1);
      }, () => left || setIsGone(true));
      return () => void (left = true);
    }, []);
    if (known) return h(known, props);
    // After an update of the daemon the scripts have other names: the page as a whole is then old.
    if (isGone) return html`<p role="alert">${t("page.not_loaded")} <button type="button" onClick=${() => location.reload()}>${t("page.reload")}</button></p>`;
    return html`<p class="help">${t("page.loading")}</p>`;
  };
}
