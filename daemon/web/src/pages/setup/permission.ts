// Whether this tab may press a button, and if not, why: the daemon decides anyhow, this tells it beforehand.
import { t, tWord } from "../../i18n/i18n.ts";
import { useStore } from "../../lib/store.ts";
import { link, topics } from "../../live/live.ts";
import { token } from "../../rpc/rpc.ts";
import { session } from "../../rpc/session.ts";
import { type Asked, type Seen, refusalOf } from "./access_rules.ts";

export function useSeen(): Seen {
  const { status } = useStore(link);
  const { who, role } = useStore(session);
  const { control, state } = useStore(topics);
  const hasToken = useStore(token) !== null;
  return { online: status === "open", hasToken, role, who, control, state };
}

// Empty = may; else the sentence that says why not.
export function useRefusal(asked: Asked): string {
  const seen = useSeen();
  const refusal = refusalOf(asked, seen);
  if (refusal === "") return "";
  if (refusal === "role") return t("setup.why.role", { role: tWord("role", asked.role) });
  if (refusal === "control_other") return t("setup.why.control_other", { owner: seen.control?.owner ?? "" });
  return tWord("setup.why", refusal);
}
