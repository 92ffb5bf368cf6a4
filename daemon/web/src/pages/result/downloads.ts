// The files that the result has; those that are being made appear by themselves.
import { number, t, tWord } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import type { ResultFile, ResultJson } from "../../result/result_json.ts";
import { useFiles } from "./use_files.ts";

// What people ask for first.
const kFirst = ["report.pdf", "height.x3p", "height.gsf", "height.csv", "height.ply"];

function sizeText(bytes: number | undefined): string {
  if (bytes === undefined) return "";
  return bytes < 100 * 1024 ? `${number(bytes / 1024, 1)} KiB` : `${number(bytes / 1024 / 1024, 1)} MiB`;
}

const rank = ({ name }: ResultFile): number => (kFirst.includes(name) ? kFirst.indexOf(name) : kFirst.length);

export function Downloads({ result }: { result: ResultJson }) {
  const { job_id } = result.job;
  const files = [...useFiles(result)].sort((a, b) => rank(a) - rank(b));
  const isThere = (name: string): boolean => files.some((file) => file.name === name && file.files === undefined && (file.state ?? "written") === "written");
  const missing = kFirst.filter((name) => !isThere(name));
  const address = (name: string): string => `/api/v1/jobs/${encodeURIComponent(job_id)}/files/${encodeURIComponent(name)}`;
  const about = (name: string): string => {
    const plain = name.replace(/^profile_.*\.png$/, "profile.png").replace(/^height_.*\.tiff$/, "height_other.tiff");
    const text = tWord("result.file", plain.replaceAll(".", "_"));
    return text === plain.replaceAll(".", "_") ? "" : text;
  };
  // A folder has no state and no bytes to give: it stays on the daemon's disk.
  const size = ({ files, size_bytes, state = "written", reason }: ResultFile): string =>
    files !== undefined ? t("result.folder", { n: number(files) })
    : state === "written" ? sizeText(size_bytes) : `${tWord("result.file_state", state)}${reason ? `: ${reason}` : ""}`;
  return html`<section class="panel downloads" aria-labelledby="downloads-title">
    <h2 id="downloads-title">${t("result.downloads")}</h2>
    <ul>${files.map((file) => html`<li>
      ${isThere(file.name)
        ? html`<a class="button" href=${address(file.name)} download=${file.name}>${file.name}</a>`
        : html`<span class="button is-missing">${file.name}</span>`}
      <span class="help">${about(file.name)} ${size(file)}</span></li>`)}
      ${!files.some(({ name }) => name === "result.json") && html`<li><a class="button" href=${address("result.json")} download="result.json">result.json</a>
        <span class="help">${t("result.file.result_json")}</span></li>`}
    </ul>
    ${missing.length > 0 && html`<p class="help">${t("result.downloads.missing", { list: missing.join(", ") })}</p>`}
  </section>`;
}
