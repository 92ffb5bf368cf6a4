// The profile tool: a line across the map, its curve, what cursors and fits tell of it.
import { useEffect, useMemo, useState } from "preact/hooks";
import { number, t, tWord } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { messageOf } from "../../parts/message_of.ts";
import { sPoints } from "../../result/fitted_geometry.ts";
import type { Measurement, ResultJson } from "../../result/result_json.ts";
import { fitCircle, fitLine, partOf } from "../../surface/profile_fits.ts";
import type { Place, ProfileLine } from "../../surface/profile_line.ts";
import { KeepProfile } from "./keep_profile.ts";
import { ProfileEnds } from "./profile_ends.ts";
import { type FitKind, ProfileFigures } from "./profile_figures.ts";
import { type Cursors, ProfilePlot } from "./profile_plot.ts";
import { ProfileTable } from "./profile_table.ts";
import type { ResultMap } from "./use_map.ts";
import { useProfile } from "./use_profile.ts";

interface Props {
  result: ResultJson;
  map: ResultMap;
  line: ProfileLine;
  measurement: Measurement | null;  // whose section the line is
  onLine: (line: ProfileLine) => void;
  onMarks: (marks: Place[]) => void;  // places of the cursors on the map
}

const told = ({ x, y }: Place): string => `${number(x, 1)}; ${number(y, 1)}`;
const lengthOf = ({ from, to }: ProfileLine): number => Math.hypot(to.x - from.x, to.y - from.y);

export function ProfilePanel({ result, map, line, measurement, onLine, onMarks }: Props) {
  const { profile, by, problem, error } = useProfile(map, line);
  const length = lengthOf(line);
  const [cursors, setCursors] = useState<Cursors>({ first: length / 4, second: (3 * length) / 4 });
  const [kind, setKind] = useState<FitKind>("none");
  const [first, second] = [Math.min(cursors.first, length), Math.min(cursors.second, length)];

  // A measurement's section has a length of its own.
  useEffect(() => {
    if (measurement) setCursors({ first: length / 4, second: (3 * length) / 4 });
  }, [measurement]);

  useEffect(() => {
    const at = (along: number): Place => ({
      x: line.from.x + ((line.to.x - line.from.x) * along) / (length || 1),
      y: line.from.y + ((line.to.y - line.from.y) * along) / (length || 1),
    });
    onMarks([at(first), at(second)]);
  }, [line.from.x, line.from.y, line.to.x, line.to.y, first, second]);

  const fit = useMemo(() => {
    if (!profile || kind === "none") return null;
    const part = partOf(profile.distance_um, profile.height_um, first, second);
    return kind === "line" ? fitLine(part) : fitCircle(part);
  }, [profile, kind, first, second]);

  const shown = { first, second };
  return html`<section class="panel profile-panel" aria-labelledby="profile-title">
    <h2 id="profile-title">${t("result.profile.title")}</h2>
    <${ProfileEnds} map=${map} line=${line} onLine=${onLine}/>
    <p class="print-only">${t("result.section", { from: told(line.from), to: told(line.to), width: number(line.width_um, 1) }).replaceAll("µm", map.unit)}</p>
    ${problem && html`<p class="problem" role="status">${tWord("result.profile.problem", problem)}</p>`}
    ${Boolean(error) && html`<p class="problem" role="alert">${messageOf(error)}</p>`}
    ${profile && profile.height_um.every((z) => z === null) && html`<p role="status">${t("result.profile.all_holes")}</p>`}
    ${profile && html`
      <${ProfilePlot} profile=${profile} unit=${map.unit} cursors=${shown} fit=${fit} section=${measurement?.cross_section ?? null}
        s_points=${measurement ? sPoints(measurement) : []} onCursors=${setCursors}/>
      <p class="help">${t(by === "daemon" ? "result.profile.by_daemon" : "result.profile.by_page")}
        ${measurement?.cross_section?.fit_name && ` ${t("result.profile.fitted", { name: measurement.cross_section.fit_name })}`}</p>
      <${ProfileFigures} profile=${profile} unit=${map.unit} cursors=${shown} kind=${kind} fit=${fit} onCursors=${setCursors} onKind=${setKind}/>
      <${ProfileTable} profile=${profile} unit=${map.unit} name=${`${result.job.job_id}-profile.csv`}/>
      <${KeepProfile} recipe=${result.job.recipe} line=${line} isPossible=${map.has_pitch}/>`}
  </section>`;
}
