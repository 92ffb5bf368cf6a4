// Who this tab is, and the way to be somebody.
import { useRef, useState } from "preact/hooks";
import { t, tWord, useLanguage } from "../i18n/i18n.ts";
import { html } from "../lib/html.ts";
import { useStore } from "../lib/store.ts";
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

  const submit = async (event: SubmitEvent): Promise<void> => {
    event.preventDefault();
    const input = (event.target as HTMLFormElement).elements.namedItem("token") as HTMLInputElement;
    if (isAsking) return;
    setAsking(true);
    setProblem("");
    try {
      await logIn(input.value.trim());
      input.value = "";
      dialog.current?.close();
    } catch (error) {
      setProblem(error instanceof RpcError && error.code === 401 ? t("session.wrong") : messageOf(error));
      input.focus();
    } finally {
      setAsking(false);
    }
  };

  if (has) {
    return html`<span class="session">
      <span class="session-who">${t("session.as", { who, role: tWord("role", role) })}</span>
      <button type="button" onClick=${() => void logOut()}>${t("session.log_out")}</button>
    </span>`;
  }
  return html`<span class="session">
    <button type="button" title=${t("session.none")} onClick=${() => dialog.current?.showModal()}>${t("session.log_in")}</button>
    <dialog ref=${dialog} aria-labelledby="log-in-title">
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
