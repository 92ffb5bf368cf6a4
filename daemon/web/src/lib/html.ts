// Components are written with htm: no compiler stands between a file and what runs.
import htm from "htm";
import { type VNode, h } from "preact";

export const html = htm.bind(h) as (strings: TemplateStringsArray, ...values: unknown[]) => VNode;
