// The map in one sentence, for those who do not see it.
import { number, t } from "../../i18n/i18n.ts";
import type { ResultJson } from "../../result/result_json.ts";
import { percentDigits } from "../../result/value_text.ts";
import { verdictWord } from "../../parts/verdict_mark.ts";

export function summaryText(result: ResultJson): string {
  const { height, valid_fraction, points } = result.values ?? {};
  const verdict = verdictWord(result.verdict);
  const share = number(percentDigits(valid_fraction ?? 0), 1);
  if (typeof height?.min_um !== "number" || typeof height.max_um !== "number") return t("result.summary.empty", { points: points ?? 0, verdict });
  return t("result.summary", { low: number(height.min_um, 2), high: number(height.max_um, 2), share, points: points ?? 0, verdict });
}
