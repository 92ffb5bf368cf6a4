// A study's figure as people read it.
import { digitsOfUncertain, usefulDigits } from "../../../lib/digits.ts";
import { shownUnit } from "../../../lib/units.ts";
import type { Figure } from "./study_types.ts";

export interface FigureText {
  value: string;
  uncertainty: string;  // "± U (k = 2)", or empty
  unit: string;
}

export function figureText(figure: Figure, told: (value: number, digits: number) => string): FigureText {
  const unit = shownUnit(figure.unit);
  if (typeof figure.value !== "number") return { value: "–", uncertainty: "", unit: "" };
  const U = figure.U ?? null;
  const digits = U !== null && U > 0 ? digitsOfUncertain(U) : usefulDigits(figure.value);
  return {
    value: told(figure.value, digits),
    uncertainty: U === null ? "" : `± ${told(U, digits)}${figure.k === undefined ? "" : ` (k = ${told(figure.k, usefulDigits(figure.k, 3))})`}`,
    unit,
  };
}
