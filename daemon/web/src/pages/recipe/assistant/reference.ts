// A stage without its reference seeks no focus: the way to it, right where it is missing.
import { asCommand } from "../../../camera/devices_turn.ts";
import { t } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { call } from "../../../rpc/rpc.ts";
import type { Run } from "./run.ts";

// Nothing but a refusal tells that it is missing.
export const isReferenceMissing = (error: string): boolean => error === "stage_not_homed";

export function Reference({ seek, onFound }: { seek: Run; onFound: () => void }) {
  const find = async (): Promise<void> => {
    await asCommand(() => call("stage.home", {}));
    onFound();
  };
  return html`<p role="alert" class="problem">${t("run.todo.1113")}</p>
    <p class="buttons"><button type="button" class="main" disabled=${seek.why !== ""} onClick=${() => seek.run(t("recipe.finding_reference"), find)}>${t("setup.move.home")}</button></p>
    <p class="help">${t("recipe.moves_stage")}</p>`;
}
