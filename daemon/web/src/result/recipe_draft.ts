// Measurements that were found on a result, put into the recipe's draft of this tab, which the recipe page shows.

interface Document {
  evaluation?: { measurements?: Record<string, unknown> };
}

export const measurementNames = (text: string): string[] => Object.keys((JSON.parse(text) as Document).evaluation?.measurements ?? {});

// The recipe's text with one more measurement. Throws where the text is no JSON: a draft may be half typed.
export function withMeasurement(text: string, name: string, measurement: Record<string, unknown>): string {
  const document = JSON.parse(text) as Document;
  const evaluation = document.evaluation ?? {};
  return `${JSON.stringify({
    ...document,
    evaluation: { ...evaluation, measurements: { ...evaluation.measurements, [name]: measurement } },
  }, null, 2)}\n`;
}

export interface LineOnMap {
  from: { x: number; y: number };
  to: { x: number; y: number };
  width_um: number;
}

// As the recipe's schema has it; to 1 nm, which no pixel is smaller than.
export function profileMeasurement({ from, to, width_um }: LineOnMap, parameters: readonly string[]): Record<string, unknown> {
  const rounded = (value: number): number => Math.round(value * 1000) / 1000;
  return {
    kind: "profile",
    from_um: [rounded(from.x), rounded(from.y)],
    to_um: [rounded(to.x), rounded(to.y)],
    ...(width_um > 0 ? { band_width_um: rounded(width_um) } : {}),
    parameters: [...parameters],
  };
}

// A name that no measurement has yet.
export function freeName(taken: readonly string[], wish = "profile"): string {
  if (!taken.includes(wish)) return wish;
  let i = 2;
  while (taken.includes(`${wish}_${i}`)) ++i;
  return `${wish}_${i}`;
}
