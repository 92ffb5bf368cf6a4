// result.json (format 2) as far as pages show it. The daemon describes it in prose (daemon/export/README.md), so that
// everything here may be absent: a page shows what is there.

export type Verdict = "pass" | "fail" | "uncertain" | "invalid";

export interface BudgetLine {
  source: string;
  type: "A" | "B";
  u: number;
  dof?: number;
  points_as_one?: number;
}

export interface Notice {
  code: string;
  text: string;
}

export interface EvaluatedValue {
  value?: number;
  unit: string;
  reason?: string;  // why there is no value
  u?: number;
  U?: number;
  k?: number;
  dof?: number;
  u_method?: string;
  budget?: BudgetLine[];
  limits?: { lower?: number; upper?: number };
  verdict?: Verdict;
  probability?: number;
  warnings?: Notice[];
}

export interface CrossSection {
  from_x_um: number;
  from_y_um: number;
  to_x_um: number;
  to_y_um: number;
  band_width_um: number;
  regions: { name: string; from_um: number; to_um: number }[];
  fit_name?: string;
  fit?: { along_um: number[]; z_um: number[] }[];
}

export interface EdgeSection {
  along_um: number;
  x_um: number;
  y_um: number;
  unmeasured?: string;
  radius_um?: number;
}

export interface Notch {
  along_um: number;
  x_um: number;
  y_um: number;
  depth_um: number;
  width_um: number;
  open?: boolean;
  resolved?: boolean;
}

export interface Measurement {
  id?: string;
  kind: string;
  method?: string;
  surface?: string;
  region?: string;
  reason?: string;
  points?: number;
  valid_fraction?: number;
  main_value?: string;
  values: Record<string, EvaluatedValue>;
  not_evaluated?: string[];
  details?: Record<string, unknown> & {
    direction_deg?: number;
    sections?: EdgeSection[];
    chipping?: { notches?: Notch[] };
  };
  cross_section?: CrossSection;
  warnings?: Notice[];
  verdict?: Verdict;
}

// A figure of the whole map.
export interface MapFigure {
  value: number | null;
  unit: string;
  limits?: { lower: number | null; upper: number | null };
  verdict?: Verdict;
}

export interface ResultFile {
  name: string;
  state?: string;  // absent of a folder
  files?: number;  // in a folder
  size_bytes?: number;
  reason?: string;
}

export interface ResultJson {
  job: { job_id: string; seq: number; part_id: string; recipe: string };
  objective?: string | null;
  temperature?: { celsius?: number; source?: string; age_s?: number } | null;
  calibration?: unknown;
  verdict: Verdict | null;
  evaluation?: {
    verdict?: Verdict | null;
    rule?: string;
    probability?: number;
    calibration?: string;
    surfaces?: Record<string, SurfaceStep[]>;
    order?: string[];
    measurements?: Record<string, Measurement>;
  };
  measurements?: Record<string, MapFigure>;
  warnings?: Notice[];
  values?: {
    height?: { min_um?: number | null; max_um?: number | null; mean_um?: number | null; median_um?: number | null } | null;
    points?: number;
    valid_points?: number;
    valid_fraction?: number;
    hole_points?: Record<string, number>;
    sigma_median_um?: number | null;
  };
  focus?: { width_px?: number; height_px?: number; pixel_pitch_x_um?: number | null; pixel_pitch_y_um?: number | null; window_px?: number; peak?: string; operator?: string };
  frames?: { expected?: number; ok?: number };
  slices?: { planned?: number; measured?: number; first_um?: number; last_um?: number; exposure_us?: number | null; scan_mode?: string };
  times?: Record<string, number>;
  provenance?: { software_version?: string; simulated?: boolean; created?: string; source?: string };
  files?: ResultFile[];
  evaluated?: string;
  source?: { job_id: string; recipe?: { id?: string }; verdict?: Verdict | null };
}

export interface SurfaceStep {
  op: string;
  did?: { points_used?: number; points_removed?: number; values?: Record<string, { value: number; standard_error?: number }> };
  [setting: string]: unknown;
}

// Measurements in the recipe's order.
export function measurementsOf(result: ResultJson): [string, Measurement][] {
  const all = result.evaluation?.measurements ?? {};
  const order = result.evaluation?.order ?? Object.keys(all);
  return order.flatMap((name): [string, Measurement][] => {
    const measurement = all[name];
    return measurement ? [[name, measurement]] : [];
  });
}

// Whose folder holds the map: an evaluation of a stored surface has none of its own.
export const mapOwner = (result: ResultJson): string => result.source?.job_id ?? result.job.job_id;

// Figures of the map that have a verdict of their own, as values of a measurement; shares in percent.
export function judgedFigures(result: ResultJson): [string, EvaluatedValue][] {
  return Object.entries(result.measurements ?? {}).flatMap(([name, { value, unit, limits, verdict }]): [string, EvaluatedValue][] => {
    if (verdict === undefined) return [];
    const isShare = unit === "1";
    const told = (key: "value" | "lower" | "upper", figure: number | null | undefined): Partial<Record<typeof key, number>> =>
      (typeof figure === "number" ? { [key]: isShare ? Number((100 * figure).toPrecision(12)) : figure } : {});
    return [[name, {
      unit: isShare ? "percent" : unit, verdict, ...told("value", value), limits: { ...told("lower", limits?.lower), ...told("upper", limits?.upper) },
    }]];
  });
}
