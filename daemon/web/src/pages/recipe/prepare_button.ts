// Makes a saved recipe the one of jobs that name none; the answer stands beside it.
import { useState } from "preact/hooks";
import { t } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { useStore } from "../../lib/store.ts";
import { topics } from "../../live/live.ts";
import { messageOf } from "../../parts/message_of.ts";
import { call } from "../../rpc/rpc.ts";
import { mayAs, session } from "../../rpc/session.ts";

export function PrepareButton({ id, help }: { id: string; help: string }) {
  const { role } = useStore(session);
  const { state } = useStore(topics);
  const [said, setSaid] = useState("");
  const [problem, setProblem] = useState("");
  const why = !mayAs(role, "operate") ? t("recipe.needs_operate") : state?.busy ? t("recipe.busy") : "";
  const prepare = (): void => {
    setSaid("");
    setProblem("");
    call("recipe.prepare", { id }).then(({ recipe }) => setSaid(t("recipe.prepared", { id: recipe })), (error: unknown) => setProblem(messageOf(error)));
  };
  return html`<span class="beside">
    <button type="button" disabled=${why !== ""} onClick=${prepare}>${t("recipe.prepare")}</button>
    <span aria-live="polite" class=${said ? "" : "help"}>${said || why || help}</span>
    ${problem && html`<span role="alert" class="problem">${problem}</span>`}
  </span>`;
}
