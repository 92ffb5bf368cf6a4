// Numbers as people type them: the decimal sign is a comma or a point, nothing groups digits.

// null = no number. An empty text is none either: who asks for one says so himself.
export function typedNumber(text: string): number | null {
  const trimmed = text.trim().replace("−", "-");
  if (!/^[+-]?(\d+([.,]\d*)?|[.,]\d+)([eE][+-]?\d+)?$/.test(trimmed)) return null;
  const value = Number(trimmed.replace(",", "."));
  return Number.isFinite(value) ? value : null;
}
