// What the map holds at one point: always that of the file at full resolution, whatever is drawn.
import { useEffect, useState } from "preact/hooks";
import { number, t, tWord } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { messageOf } from "../../parts/message_of.ts";
import type { FullMap, Point } from "../../surface/full_map.ts";
import { reasonsOf } from "../../surface/hole_reasons.ts";
import { middleOf } from "../../surface/map_view.ts";
import type { ResultMap } from "./use_map.ts";

interface Values {
  column: number;
  row: number;
  height_m: number;
  sigma_m: number;
  texture: number;
  reason: number;
}

// A result may lack its texture or its standard errors: the height must be told nevertheless.
async function valuesAt(full: FullMap, point: Point): Promise<Values> {
  const orNothing = (kind: "sigma" | "texture" | "reason"): Promise<number> => full.at(kind, point).catch(() => NaN);
  const [height_m, sigma_m, texture, reason] = await Promise.all(
    [full.at("height", point), orNothing("sigma"), orNothing("texture"), orNothing("reason")] as const);
  return { ...point, height_m, sigma_m, texture, reason };
}

const kHeightDigits = 4;  // 0.1 nm, as result.json has it

// `machine` is the value as the file has it; what people read is rounded.
function Figure({ name, machine, shown, unit }: { name: string; machine: number; shown: string; unit: string }) {
  return html`<div><dt>${name}</dt><dd><data value=${String(machine)}>${shown}</data>${Number.isNaN(machine) ? "" : ` ${unit}`}</dd></div>`;
}

export function Readout({ map, cursor, byKeyboard }: { map: ResultMap; cursor: Point | null; byKeyboard: boolean }) {
  const [values, setValues] = useState<Values | null>(null);
  const [problem, setProblem] = useState("");
  useEffect(() => {
    if (!cursor) return;
    let gone = false;
    valuesAt(map.full, cursor).then(
      (found) => {
        if (gone) return;
        setValues(found);
        setProblem("");
      },
      (error: unknown) => {
        if (!gone) setProblem(messageOf(error));
      });
    return () => void (gone = true);
  }, [map, cursor?.column, cursor?.row]);

  if (!cursor) return html`<p class="readout help">${t("result.readout.none")}</p>`;
  if (problem) return html`<p class="readout problem" role="alert">${problem}</p>`;
  const at = middleOf(map.size, cursor);
  const here = values?.column === cursor.column && values.row === cursor.row ? values : null;
  const reasons = here ? reasonsOf(here.reason).map(({ name }) => tWord("result.reason", name)).join(", ") : "";
  const height_um = (here?.height_m ?? NaN) * 1e6;
  return html`<dl class="readout" data-column=${cursor.column} data-row=${cursor.row} data-state=${here ? "there" : "coming"} aria-live=${byKeyboard ? "polite" : "off"} aria-atomic="true">
    <${Figure} name="x" machine=${at.x} shown=${number(at.x, 2)} unit=${map.unit}/>
    <${Figure} name="y" machine=${at.y} shown=${number(at.y, 2)} unit=${map.unit}/>
    <${Figure} name="z" machine=${here?.height_m ?? NaN} shown=${here ? (Number.isNaN(height_um) ? t("result.hole") : number(height_um, kHeightDigits)) : "…"} unit="µm"/>
    <${Figure} name="σ" machine=${here?.sigma_m ?? NaN} shown=${here ? number(here.sigma_m * 1e6, kHeightDigits) : "…"} unit="µm"/>
    <${Figure} name=${t("result.kind.texture")} machine=${here?.texture ?? NaN} shown=${here ? number(here.texture, 0) : "…"} unit=""/>
    <div><dt>${t("result.readout.state")}</dt><dd>${here ? reasons || (Number.isNaN(here.height_m) ? t("result.hole") : t("result.readout.valid")) : "…"}</dd></div>
  </dl>`;
}
