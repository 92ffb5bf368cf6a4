import { html } from "../../../lib/html.ts";

export function Assistant(_: { taken: readonly string[] }) {
  return html`<p></p>`;
}
