// One result: what was measured, on which surface, and why the values are what they are.
import { useEffect, useMemo, useState } from "preact/hooks";
import { t, useLanguage } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { messageOf } from "../../parts/message_of.ts";
import { shapesOf } from "../../result/fitted_geometry.ts";
import { type ResultJson, mapOwner } from "../../result/result_json.ts";
import type { MapSize } from "../../surface/map_view.ts";
import type { Place, ProfileLine } from "../../surface/profile_line.ts";
import { Conditions } from "./conditions.ts";
import { Downloads } from "./downloads.ts";
import { EvaluateAgain } from "./evaluate_again.ts";
import { MapPanel } from "./map_panel.ts";
import { MeasurementTable } from "./measurement_table.ts";
import { NoResult } from "./no_result.ts";
import { ProfilePanel } from "./profile_panel.ts";
import { ResultHead } from "./result_head.ts";
import { summaryText } from "./summary_text.ts";
import { useMap, useOverview } from "./use_map.ts";
import { useResult } from "./use_result.ts";
import { View3dPanel } from "./view3d_panel.ts";
import "../../style/result.css";

// Across the middle, with ends that one can take hold of.
const firstLine = ({ width, height, pitch_x, pitch_y }: MapSize): ProfileLine => ({
  from: { x: 0.05 * width * pitch_x, y: (height * pitch_y) / 2 },
  to: { x: 0.95 * width * pitch_x, y: (height * pitch_y) / 2 },
  width_um: 0,
});

function Shown({ result, ended_utc }: { result: ResultJson; ended_utc: string }) {
  const { tile, error } = useOverview(mapOwner(result), "height");
  const map = useMap(result, tile);
  const [typed, setLine] = useState<ProfileLine | null>(null);
  const [marks, setMarks] = useState<Place[]>([]);
  const [name, setName] = useState<string | null>(null);
  const [is3d, set3d] = useState(false);
  const measurement = (name !== null && result.evaluation?.measurements?.[name]) || null;
  const shapes = useMemo(() => (measurement ? shapesOf(measurement) : []), [measurement]);
  const first = useMemo(() => (map ? firstLine(map.size) : null), [map]);
  const line = typed ?? first;
  const summary = summaryText(result);

  // A measurement is shown along its own section; a line that is moved then is one's own again.
  const show = (wanted: string | null): void => {
    setName(wanted);
    const section = wanted === null ? null : result.evaluation?.measurements?.[wanted]?.cross_section;
    if (section) {
      setLine({ from: { x: section.from_x_um, y: section.from_y_um }, to: { x: section.to_x_um, y: section.to_y_um }, width_um: section.band_width_um });
    }
  };
  const section = measurement?.cross_section;
  const isOnSection = Boolean(section && line && section.from_x_um === line.from.x && section.from_y_um === line.from.y
    && section.to_x_um === line.to.x && section.to_y_um === line.to.y);

  return html`<div class="result-page">
    <${ResultHead} result=${result} ended_utc=${ended_utc}/>
    <div class="result-columns">
      <div class="panels">
        <div class="view-choice buttons" role="group" aria-label=${t("result.view")}>
          <button type="button" aria-pressed=${!is3d} onClick=${() => set3d(false)}>2D</button>
          <button type="button" aria-pressed=${is3d} onClick=${() => set3d(true)}>3D</button>
          <button type="button" onClick=${() => print()}>${t("result.print")}</button>
        </div>
        ${Boolean(error) && html`<section class="panel"><p class="problem" role="alert">${messageOf(error)}</p><p class="help">${summary}</p></section>`}
        ${!map && !error && html`<section class="panel"><p role="status">${t("result.map.coming")}</p></section>`}
        ${map && line && !is3d && html`<${MapPanel} result=${result} map=${map} summary=${summary} shapes=${shapes} line=${line} marks=${marks} onLine=${setLine}/>`}
        ${map && is3d && html`<${View3dPanel} map=${map} summary=${summary}/>`}
        ${map && line && html`<${ProfilePanel} result=${result} map=${map} line=${line} measurement=${isOnSection ? measurement : null} onLine=${setLine} onMarks=${setMarks}/>`}
      </div>
      <div class="panels">
        <section class="panel screen-only" aria-labelledby="measurements-title">
          <h2 id="measurements-title">${t("result.measurements")}</h2>
          <${MeasurementTable} result=${result} shown=${name} onShow=${show}/>
        </section>
        <section class="panel print-only" aria-hidden="true"><h2>${t("result.measurements")}</h2>
          <${MeasurementTable} result=${result} shown=${null} all onShow=${() => undefined}/></section>
        <details class="panel screen-only" open><summary>${t("result.conditions")}</summary><${Conditions} result=${result}/></details>
        <section class="panel print-only" aria-hidden="true"><h2>${t("result.conditions")}</h2><${Conditions} result=${result}/></section>
        <${Downloads} result=${result}/>
        <${EvaluateAgain} result=${result}/>
      </div>
    </div>
  </div>`;
}

export function ResultPage({ id }: { id: string }) {
  useLanguage();
  const loaded = useResult(id);
  const title = loaded.kind === "result" ? loaded.result.job.part_id : id;
  useEffect(() => {
    const before = document.title;
    document.title = `${title} – fvd`;
    return () => void (document.title = before);
  }, [title]);
  switch (loaded.kind) {
    case "result": return html`<${Shown} key=${loaded.result.job.job_id} result=${loaded.result} ended_utc=${loaded.ended_utc}/>`;
    case "none": return html`<${NoResult} id=${id} status=${loaded.status}/>`;
    case "problem": return html`<h1><bdi>${id}</bdi></h1><p class="problem" role="alert">${messageOf(loaded.error)}</p>`;
    default: return html`<h1><bdi>${id}</bdi></h1><p role="status">${t("result.coming")}</p>`;
  }
}
