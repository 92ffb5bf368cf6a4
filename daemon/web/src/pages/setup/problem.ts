// An error beside what caused it: spoken at once, and never by colour alone.
import { html } from "../../lib/html.ts";

export function Problem({ text }: { text: string }) {
  return text ? html`<p class="problem" role="alert"><span aria-hidden="true">▲ </span>${text}</p>` : null;
}
