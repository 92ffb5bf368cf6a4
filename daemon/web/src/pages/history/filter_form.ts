// Which jobs are wanted.
import { useEffect, useRef, useState } from "preact/hooks";
import { t, tWord } from "../../i18n/i18n.ts";
import { type Wanted, kVerdicts } from "../../history/filter.ts";
import { html } from "../../lib/html.ts";
import { call } from "../../rpc/rpc.ts";

const kPause_ms = 250;

export function FilterForm({ wanted, onChange }: { wanted: Wanted; onChange: (wanted: Wanted) => void }) {
  const [recipes, setRecipes] = useState<string[]>([]);
  const timer = useRef<ReturnType<typeof setTimeout> | undefined>(undefined);
  const newest = useRef(wanted);
  newest.current = wanted;
  useEffect(() => {
    call("recipe.list", {}).then((answer) => setRecipes(answer.recipes as string[]), () => undefined);
    return () => clearTimeout(timer.current);
  }, []);
  const set = (name: keyof Wanted, pause_ms: number) => (event: Event): void => {
    const value = (event.target as HTMLInputElement).value;
    clearTimeout(timer.current);
    timer.current = setTimeout(() => onChange({ ...newest.current, [name]: value }), pause_ms);
  };
  // A recipe that is gone may still be sought.
  const offered = wanted.recipe && !recipes.includes(wanted.recipe) ? [...recipes, wanted.recipe] : recipes;
  return html`<form class="panel filter" onSubmit=${(event: Event) => event.preventDefault()} aria-label=${t("history.filter")}>
    <label>${t("history.part")} <input value=${wanted.part} maxlength="64" dir="auto" autocomplete="off" onInput=${set("part", kPause_ms)}/></label>
    <label>${t("history.recipe")} <select value=${wanted.recipe} onChange=${set("recipe", 0)}>
      <option value="">${t("history.all")}</option>${offered.map((id) => html`<option value=${id}>${id}</option>`)}</select></label>
    <label>${t("history.verdict")} <select value=${wanted.verdict} onChange=${set("verdict", 0)}>
      <option value="">${t("history.all")}</option>
      ${kVerdicts.map((each) => html`<option value=${each}>${tWord("verdict", each)}</option>`)}</select></label>
    <label>${t("history.from")} <input type="date" value=${wanted.from} onChange=${set("from", 0)}/></label>
    <label>${t("history.to")} <input type="date" value=${wanted.to} onChange=${set("to", 0)}/></label>
    <label>${t("history.text")} <input type="search" value=${wanted.text} maxlength="64" dir="auto" autocomplete="off" onInput=${set("text", kPause_ms)}/></label>
  </form>`;
}
