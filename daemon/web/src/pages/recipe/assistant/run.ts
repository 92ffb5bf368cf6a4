// One thing at a time that the station is asked to do, and what came of it.
import { useState } from "preact/hooks";
import { t } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { useStore } from "../../../lib/store.ts";
import { topics } from "../../../live/live.ts";
import { messageOf } from "../../../parts/message_of.ts";
import { RpcError } from "../../../rpc/rpc.ts";
import { mayAs, session } from "../../../rpc/session.ts";

export interface Run {
  busy: string;
  why: string;  // the reason why nothing can be asked for; "" = it can
  run(saying: string, what: (say: (text: string) => void) => Promise<void>): void;
  error: string;  // the name of what the last one failed for; "" = it did not, or it has none
  view: unknown;
}

export function useRun(): Run {
  const { role } = useStore(session);
  const { state } = useStore(topics);
  const [busy, setBusy] = useState("");
  const [problem, setProblem] = useState("");
  const [error, setError] = useState("");
  const why = !mayAs(role, "set_up") ? t("recipe.needs_set_up") : busy !== "" ? busy : state?.busy ? t("recipe.busy") : "";
  const run: Run["run"] = (saying, what) => {
    setBusy(saying);
    setProblem("");
    setError("");
    what(setBusy).catch((reason: unknown) => {
      setProblem(messageOf(reason));
      setError(reason instanceof RpcError ? reason.error : "");
    }).finally(() => setBusy(""));
  };
  const view = html`<p aria-live="polite" class="help">${why}</p>${problem && html`<p role="alert" class="problem">${problem}</p>`}`;
  return { busy, why, run, error, view };
}
