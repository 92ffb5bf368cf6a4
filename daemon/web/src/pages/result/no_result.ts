// A job without a result: it runs, failed, was aborted, or nobody knows it.
import { number, t, tWord } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import type { JobStatus } from "./use_result.ts";

export function NoResult({ id, status }: { id: string; status: JobStatus }) {
  const failed = status.done;
  return html`<h1><bdi>${status.part_id || id}</bdi></h1>
    <p role=${failed ? "alert" : "status"} class=${failed ? "problem" : ""}>${tWord("result.state", status.state)}${
      !failed && `: ${number(Math.round(status.progress * 100))} %`}</p>
    ${status.error_message && html`<p>${status.error_message}${status.error && ` (${status.error}, ${status.error_code})`}</p>`}
    ${failed && html`<p class="help">${t("result.failed.help")}</p>`}
    ${!failed && html`<p class="help">${t("result.running.help")}</p>`}
    <p><a href="/">${t("page.back")}</a></p>`;
}
