// A document as people write recipes: short lists and objects on one line, everything else with two spaces a level.
import { type Json, isObject } from "./schema.ts";

const kLongestLine = 110;

function onOneLine(value: Json): string {
  if (Array.isArray(value)) return `[${value.map(onOneLine).join(", ")}]`;
  if (!isObject(value)) return JSON.stringify(value);
  const entries = Object.entries(value);
  return entries.length === 0 ? "{}" : `{ ${entries.map(([key, each]) => `${JSON.stringify(key)}: ${onOneLine(each)}`).join(", ")} }`;
}

const depthOf = (value: Json): number =>
  typeof value !== "object" || value === null ? 0 : 1 + Math.max(0, ...Object.values(value).map(depthOf));

function format(value: Json, indent: string, used: number): string {
  const line = onOneLine(value);
  if (depthOf(value) <= 3 && indent !== "" && indent.length + used + line.length <= kLongestLine) return line;
  if (Array.isArray(value) && value.length > 0) {
    const inner = `${indent}  `;
    return `[\n${value.map((each) => inner + format(each, inner, 0)).join(",\n")}\n${indent}]`;
  }
  if (!isObject(value) || Object.keys(value).length === 0) return line;
  const inner = `${indent}  `;
  const lines = Object.entries(value).map(([key, each]) => {
    const name = `${JSON.stringify(key)}: `;
    return inner + name + format(each, inner, name.length);
  });
  return `{\n${lines.join(",\n")}\n${indent}}`;
}

export const formatJson = (value: Json): string => `${format(value, "", 0)}\n`;
