// The versions of a recipe that are kept: who saved them, when, why; any can be saved anew.
import { useEffect, useState } from "preact/hooks";
import { t } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { useStore } from "../../lib/store.ts";
import { messageOf } from "../../parts/message_of.ts";
import { dropDraft } from "../../recipe/draft.ts";
import { call } from "../../rpc/rpc.ts";
import { mayAs, session } from "../../rpc/session.ts";

interface Version {
  version: number;
  saved: string;
  author: string;
  comment: string;
}

export function VersionList({ id, version, isChanged, onRestored }: { id: string; version: number; isChanged: boolean; onRestored: (version: number) => void }) {
  const { who, role } = useStore(session);
  const [versions, setVersions] = useState<Version[] | null>(null);
  const [asked, setAsked] = useState<number | null>(null);
  const [problem, setProblem] = useState("");
  useEffect(() => {
    call("recipe.versions", { id }).then(
      (answer) => setVersions(answer.versions as Version[]),
      (error) => setProblem(messageOf(error)),
    );
  }, [id, version]);
  const restore = async (wanted: number): Promise<void> => {
    try {
      const { version: made } = await call("recipe.restore", { id, version: wanted, base_version: version, author: who });
      dropDraft(id);
      onRestored(made);
    } catch (error) {
      setProblem(messageOf(error));
    }
  };
  const may = mayAs(role, "set_up");
  const rows = [...(versions ?? []), { version: 0, saved: "", author: "", comment: t("recipe.shipped") }];
  return html`
    ${problem && html`<p role="alert" class="problem">${problem}</p>`}
    ${!may && html`<p class="help">${t("recipe.needs_set_up")}</p>`}
    <p class="help">${t("recipe.versions_help")}</p>
    <div class="scroll"><table>
      <thead><tr><th class="number">${t("recipe.version")}</th><th>${t("recipe.saved_at")}</th><th>${t("recipe.author")}</th><th>${t("recipe.comment")}</th><th></th></tr></thead>
      <tbody>${rows.map((each) => html`<tr key=${each.version}>
        <td class="number">${each.version}</td><td>${each.saved}</td><td class="long" dir="auto">${each.author}</td><td class="long" dir="auto">${each.comment}</td>
        <td>${each.version === version ? html`<strong>${t("recipe.in_force")}</strong>`
          : asked === each.version ? html`<span class="buttons">
              <button type="button" onClick=${() => void restore(each.version)}>${isChanged ? t("recipe.restore_lose") : t("recipe.restore_sure")}</button>
              <button type="button" onClick=${() => setAsked(null)}>${t("cancel")}</button></span>`
          : html`<button type="button" disabled=${!may} aria-label=${t("recipe.restore_version", { version: each.version })} onClick=${() => setAsked(each.version)}>${t("recipe.restore")}</button>`}</td>
      </tr>`)}</tbody>
    </table></div>`;
}
