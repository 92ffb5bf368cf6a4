// A value of the recipe as a field, by its schema.
import { html } from "../../../lib/html.ts";
import type { Path } from "../../../recipe/document.ts";
import type { Schema } from "../../../recipe/schema.ts";
import type { Editor } from "../editor.ts";
import { ChoiceField } from "./choice_field.ts";
import { ListField } from "./list_field.ts";
import { MapField } from "./map_field.ts";
import { NamesField } from "./names_field.ts";
import { NumberField } from "./number_field.ts";
import { ObjectField } from "./object_field.ts";
import { PairField } from "./pair_field.ts";
import { ShapeField } from "./shape_field.ts";
import { TextField } from "./text_field.ts";

export interface FieldProps {
  editor: Editor;
  schema: Schema;
  path: Path;
  required: boolean;
}

function componentOf(schema: Schema) {
  if (schema.oneOf) return ShapeField;
  if (schema.enum || schema.type === "boolean") return ChoiceField;
  switch (schema.type) {
    case "number":
    case "integer": return NumberField;
    case "array":
      if (schema.items?.enum || schema.items?.type === "string") return NamesField;
      if (schema.items?.type === "number" && schema.maxItems === 2) return PairField;
      return ListField;
    case "object": return isObjectOfNames(schema) ? MapField : ObjectField;
    default: return TextField;
  }
}

const isObjectOfNames = (schema: Schema): boolean => typeof schema.additionalProperties === "object";

export function Field(props: FieldProps) {
  return html`<${componentOf(props.schema)} ...${props}/>`;
}
