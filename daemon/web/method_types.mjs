// Types of all methods from the daemon's own description: a key that is renamed there breaks the page's build.
const kSpace = "  ";

function typeOf(schema, indent) {
  if (!schema || Object.keys(schema).length === 0) return "unknown";
  if (schema.const !== undefined) return JSON.stringify(schema.const);
  if (schema.enum) return schema.enum.map((value) => JSON.stringify(value)).join(" | ");
  for (const key of ["oneOf", "anyOf"]) {
    if (schema[key]) return schema[key].map((each) => typeOf(each, indent)).join(" | ");
  }
  const one = (type) => {
    switch (type) {
      case "string": return "string";
      case "number":
      case "integer": return "number";
      case "boolean": return "boolean";
      case "null": return "null";
      case "array": return `(${typeOf(schema.items, indent)})[]`;
      case "object": return objectOf(schema, indent);
      default: return "unknown";
    }
  };
  if (Array.isArray(schema.type)) return schema.type.map(one).join(" | ");
  return one(schema.type ?? (schema.properties ? "object" : ""));
}

function objectOf(schema, indent) {
  const names = Object.keys(schema.properties ?? {});
  if (names.length === 0) return "Record<string, unknown>";
  // What a reply with chosen fields may leave out is there whenever none were chosen, and this page chooses none.
  const required = new Set(schema.required ?? schema["x-required-without-fields"] ?? []);
  const inner = indent + kSpace;
  const lines = names.map((name) => {
    const about = schema.properties[name];
    const note = about.description ? `${inner}/** ${about.description.replaceAll("*/", "* /")} */\n` : "";
    return `${note}${inner}${JSON.stringify(name)}${required.has(name) ? "" : "?"}: ${typeOf(about, inner)};`;
  });
  return `{\n${lines.join("\n")}\n${indent}}`;
}

// The text of src/rpc/methods.ts.
export function methodTypes(openrpc) {
  const lines = ["// Made by build.mjs from openrpc.json; not to be edited.", "export interface Methods {"];
  for (const method of openrpc.methods) {
    const params = {
      type: "object",
      properties: Object.fromEntries(method.params.map((param) => [param.name, param.schema])),
      required: method.params.filter((param) => param.required).map((param) => param.name),
    };
    const isEmpty = method.params.length === 0;
    lines.push(`${kSpace}${JSON.stringify(method.name)}: {`);
    lines.push(`${kSpace}${kSpace}params: ${isEmpty ? "Record<string, never>" : objectOf(params, kSpace + kSpace)};`);
    lines.push(`${kSpace}${kSpace}result: ${typeOf(method.result?.schema, kSpace + kSpace)};`);
    lines.push(`${kSpace}};`);
  }
  lines.push("}", "");
  return lines.join("\n");
}
