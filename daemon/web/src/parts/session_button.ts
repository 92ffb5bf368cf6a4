// Who this tab is, and the way to be somebody.
import { useEffect, useRef, useState } from "preact/hooks";
import { t, tWord, useLanguage } from "../i18n/i18n.ts";
import { html } from "../lib/html.ts";
import { useStore } from "../lib/store.ts";
import { leaveControl } from "../rpc/held_control.ts";
import { RpcError, token } from "../rpc/rpc.ts";
import { logIn, logOut, session } from "../rpc/session.ts";
import { messageOf } from "./message_of.ts";

export function SessionButton() {
  useLanguage();
  const { who, role } = useStore(session);
  const has = useStore(token) !== null;
  const dialog = useRef<HTMLDialogElement>(null);
  const [problem, setProblem] = useState("");
  const [isAsking, setAsking] = useState(false);
  const asking = useRef<AbortController | null>(null);

  // However the dialog was closed, nobody is logged in by it any more.
  const giveUp = (): void => {
    asking.current?.abort();
    asking.current = null;
    setAsking(false);
  };
  useEffect(() => giveUp, []);
  const closed = (event: Event): void => {
    giveUp();
    setProblem("");
    (event.target as HTMLElement).querySelector("form")?.reset();
  };
  const submit = async (event: SubmitEvent): Promise<void> => {
    event.preventDefault();
    const input = (event.target as HTMLFormElement).elements.namedItem("token") as HTMLInputElement;
    if (asking.current) return;
    const mine = new AbortController();
    asking.current = mine;
    setAsking(true);
    setProblem("");
    try {
      await logIn(input.value.trim(), mine.signal);
      dialog.current?.close();
    } catch (error) {
      if (mine.signal.aborted) return;
      setProblem(error instanceof RpcError && error.code === 401 ? t("session.wrong") : messageOf(error));
      input.focus();
    } finally {
      if (asking.current === mine) giveUp();
    }
  };
  const leave = (): void => {
    leaveControl();  // nobody could take it before its time is over
    logOut().catch(() => undefined);  // who one is without a token is asked again after the next reconnection
  };

  if (has) {
    return html`<span class="session">
      <span class="session-who">${t("session.as", { who, role: tWord("role", role) })}</span>
      <button type="button" onClick=${leave}>${t("session.log_out")}</button>
    </span>`;
  }
  return html`<span class="session">
    <button type="button" title=${t("session.none")} onClick=${() => dialog.current?.showModal()}>${t("session.log_in")}</button>
    <dialog ref=${dialog} aria-labelledby="log-in-title" onClose=${closed}>
      <form method="dialog" onSubmit=${submit}>
        <h2 id="log-in-title">${t("session.log_in")}</h2>
        <label>${t("session.token")}
          <input name="token" type="password" autocomplete="off" required maxlength="256" aria-describedby="token-help"/>
        </label>
        <p id="token-help" class="help">${t("session.token_help")}</p>
        ${problem && html`<p role="alert" class="problem">${problem}</p>`}
        <p role="status">${isAsking && t("session.asking")}</p>
        <p class="buttons">
          <button type="submit" class="main" aria-disabled=${isAsking}>${t("session.log_in")}</button>
          <button type="button" onClick=${() => dialog.current?.close()}>${t("cancel")}</button>
        </p>
      </form>
    </dialog>
  </span>`;
}
