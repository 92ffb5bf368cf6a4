// Studies as the daemon tells them; its description says of them that they are objects.
export interface Figure {
  name: string;
  value: number | null;
  unit: string;
  u?: number;
  U?: number;
  k?: number;
  reason: string;
}

export interface Study {
  id: string;
  kind: string;
  time: string;
  person: string;
  objective: string;
  simulated: boolean;
  jobs: string[];
  figures: Figure[];
  warnings: { code: string; text: string }[];
  refusals: unknown[];
  files: string[];
  proposal?: Record<string, unknown>;
}

export interface StudyReply {
  study: Study;
  directory: string;
  report: string;
}

export interface ListedStudy {
  id: string;
  kind: string;
  time: string;
  person: string;
  objective: string;
  recipe: string;
  jobs: number;
  simulated: boolean;
  warnings: number;
  calibration?: string | null;
}
