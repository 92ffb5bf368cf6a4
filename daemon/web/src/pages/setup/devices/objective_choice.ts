// Which objective is in place: a person looks and says so; recipes that name another are then refused.
import { useEffect, useState } from "preact/hooks";
import { number, t, useLanguage } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { useStore } from "../../../lib/store.ts";
import { topics } from "../../../live/live.ts";
import { messageOf } from "../../../parts/message_of.ts";
import { call } from "../../../rpc/rpc.ts";
import { clockTime } from "../journal/clock_time.ts";
import { useRefusal } from "../permission.ts";
import { Problem } from "../problem.ts";
import { useCommand } from "../use_command.ts";

type Objectives = Awaited<ReturnType<typeof call<"objective.list">>>;

interface Objective {
  name: string;
  na?: number;
  magnification?: number;
  working_distance_mm?: number;
  min_um?: number;
  max_um?: number;
}

export function ObjectiveChoice() {
  useLanguage();
  const { state } = useStore(topics);
  const [known, setKnown] = useState<Objectives | null>(null);
  const [person, setPerson] = useState("");
  const { running, problem, run } = useCommand<void>();
  const [trouble, setTrouble] = useState("");
  const why = useRefusal({ role: "operate", control: true, still: true });
  const confirmed = known?.objective ?? "";

  const fetchList = async (): Promise<void> => setKnown(await call("objective.list", {}));
  useEffect(() => {
    fetchList().then(() => setTrouble(""), (error: unknown) => setTrouble(messageOf(error)));
  }, [state?.objective]);

  const list = (known?.objectives ?? []) as Objective[];
  const told = (value: number | undefined): string => (value === undefined ? "–" : number(value));
  return html`<section class="panel" aria-labelledby="objective-title">
    <h2 id="objective-title">${t("setup.objective.title")}</h2>
    <p>${confirmed === "" ? t("setup.objective.none") : t("setup.objective.is", { name: confirmed, person: known?.person ?? "", time: clockTime(known?.confirmed_utc ?? "") })}</p>
    ${known && list.length === 0 && html`<p class="help">${t("setup.objective.not_configured")}</p>`}
    ${list.length > 0 && html`<label class="field">${t("setup.objective.person")}
        <input value=${person} maxlength="64" onInput=${(event: Event) => setPerson((event.target as HTMLInputElement).value)}/></label>
      <div class="scroll" tabindex="0" role="group" aria-labelledby="objective-title"><table>
        <tr><th scope="col">${t("setup.objective.name")}</th><th scope="col" class="number">NA</th><th scope="col" class="number">×</th><th scope="col" class="number">${t("setup.objective.limits")}</th><th scope="col">${t("setup.objective.confirm")}</th></tr>
        ${list.map((each) => html`<tr key=${each.name}>
          <td>${each.name}</td><td class="number">${told(each.na)}</td><td class="number">${told(each.magnification)}</td>
          <td class="number">${told(each.min_um)} … ${told(each.max_um)}</td>
          <td><button type="button" disabled=${why !== "" || running} aria-label=${t("setup.objective.confirm_of", { name: each.name })}
            onClick=${() => void run(async () => {
              await call("objective.confirm", { name: each.name, person });
              await fetchList();
            })}>${t("setup.objective.confirm")}</button></td>
        </tr>`)}
      </table></div>
      <p class="help">${why}</p>`}
    <${Problem} text=${problem || trouble}/>
  </section>`;
}
