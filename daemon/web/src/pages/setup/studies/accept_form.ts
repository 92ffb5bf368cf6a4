// Proposed constants become valid by a named person's hand, with a last day; nothing else makes them valid.
import { useState } from "preact/hooks";
import { t, useLanguage } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { call } from "../../../rpc/rpc.ts";
import { useRefusal } from "../permission.ts";
import { Problem } from "../problem.ts";
import { useCommand } from "../use_command.ts";
import type { Study } from "./study_types.ts";

type Accepted = Awaited<ReturnType<typeof call<"calibrate.accept">>>;

interface Props {
  study: Study;
  calibration: string | null | undefined;
  accepted: () => void;
}

export function AcceptForm({ study, calibration, accepted }: Props) {
  useLanguage();
  const [typed, setTyped] = useState({ person: study.person, renew_by: "", certificate: "" });
  const { running, answer, problem, run } = useCommand<Accepted>();
  const why = useRefusal({ role: "administer" });
  const set = (name: keyof typeof typed) => (event: Event): void => setTyped({ ...typed, [name]: (event.target as HTMLInputElement).value });
  const isWhole = typed.person.trim() !== "" && typed.renew_by !== "";
  const hinders = study.refusals.length > 0;
  const version = answer?.calibration ?? calibration ?? "";

  const submit = async (event: Event): Promise<void> => {
    event.preventDefault();
    if (!isWhole || why !== "" || running || hinders) return;
    const done = await run(() => call("calibrate.accept", { study: study.id, person: typed.person.trim(), renew_by: typed.renew_by, certificate: typed.certificate.trim() }));
    if (done) accepted();
  };
  return html`<section aria-labelledby="accept-title">
    <h3 id="accept-title">${t("setup.accept.title")}</h3>
    <pre class="scroll" tabindex="0" role="group" aria-label=${t("setup.accept.proposal")}>${JSON.stringify(study.proposal, null, 2)}</pre>
    <p aria-live="polite">${version ? t("setup.accept.valid", { version }) : t("setup.accept.not_yet")}</p>
    <form onSubmit=${submit}>
      <div class="fields">
        <label class="field">${t("setup.accept.person")} <input required maxlength="64" value=${typed.person} onInput=${set("person")}/></label>
        <label class="field">${t("setup.accept.renew_by")} <input required type="date" value=${typed.renew_by} onInput=${set("renew_by")}/></label>
        <label class="field">${t("setup.accept.certificate")} <input maxlength="64" value=${typed.certificate} onInput=${set("certificate")}/></label>
      </div>
      <p class="buttons"><button type="submit" disabled=${!isWhole || why !== "" || running || hinders}>${t("setup.accept.go")}</button></p>
      <p class="help">${hinders ? t("setup.accept.refused") : why || t("setup.accept.help")}</p>
      <${Problem} text=${problem}/>
    </form>
  </section>`;
}
