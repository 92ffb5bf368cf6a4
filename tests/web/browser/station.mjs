// A simulated station of its own: fvd-sim and fvd with tokens, on free ports, in a folder that goes away.
//
// FVD_PAGE_URL with FVD_PAGE_TOKEN (of the role "administer") and FVD_PAGE_OPERATOR (of the role "operate") names a
// station that runs already: it is used and left running.
import { execFileSync, spawn } from "node:child_process";
import { cpSync, createWriteStream, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { build, root } from "./paths.mjs";
import { until } from "./wait.mjs";

const freePort = () => new Promise((tell, fail) => {
  const server = createServer();
  server.on("error", fail);
  server.listen(0, "127.0.0.1", () => {
    const { port } = server.address();
    server.close(() => tell(port));
  });
});

const readJson = (path) => {
  try {
    return JSON.parse(readFileSync(path, "utf8"));
  } catch {
    return null;  // not there yet, or not whole
  }
};

function run(program, args, log) {
  const child = spawn(program, args, { stdio: ["ignore", "pipe", "pipe"] });
  const out = createWriteStream(log, { flags: "a" });
  child.stdout.pipe(out);
  child.stderr.pipe(out);
  child.ended = new Promise((tell) => {
    child.on("exit", tell);
    child.on("error", (error) => {  // it could not be started: there is no exit
      console.error(error.message);
      tell();
    });
  });
  return child;
}

async function started(child, name, log, condition) {
  let gone = false;
  void child.ended.then(() => (gone = true));
  return until(name, () => {
    if (gone) throw new Error(`${name} ended: ${readFileSync(log, "utf8").slice(-2000)}`);
    return condition();
  });
}

async function ended(child, signal = "SIGTERM") {
  if (!child) return;
  child.kill(signal);
  const late = setTimeout(() => child.kill("SIGKILL"), 20000);
  await child.ended;
  clearTimeout(late);
}

// A client of the daemon beside the page: what the page should show is compared with what this is told.
export function caller(url, token) {
  let id = 0;
  return async (method, params = {}) => {
    const response = await fetch(new URL("/api/jsonrpc", url), {
      method: "POST",
      headers: { "Content-Type": "application/json", Authorization: `Bearer ${token}` },
      body: JSON.stringify({ jsonrpc: "2.0", id: ++id, method, params }),
    });
    const reply = JSON.parse(await response.text());
    if (reply.error) throw Object.assign(new Error(`${method}: ${reply.error.message ?? reply.message}`), { code: reply.error.code });
    return reply.result;
  };
}

// world, plant: names in sim/worlds and sim/plants. settings: of the configuration, by "group.key". recipes: documents by
// id, beside the shipped ones. A station of its own also has
//   state      the folder of results and database
//   motions    file of the stage's commands and motions (fvd-sim --motion-log), in memory
//   fvd()      the daemon's process
//   options    of the daemon's command line
//   restart({ signal, between })  ends the daemon, awaits between(state) without one, starts it at the same address
export async function startStation({ world = "groove_50", plant = "chapter", settings = {}, recipes = {} } = {}) {
  if (process.env.FVD_PAGE_URL) {
    const { FVD_PAGE_URL: url, FVD_PAGE_TOKEN: token, FVD_PAGE_OPERATOR: operator = token } = process.env;
    if (!token) throw new Error("FVD_PAGE_URL needs FVD_PAGE_TOKEN: a token of the role administer");
    return { url, token, operator, call: caller(url, token), stop: async () => undefined };
  }
  const programs = { sim: join(build, "sim/fvd-sim"), fvd: join(build, "daemon/fvd"), ctl: join(build, "daemon/ctl/fvdctl") };
  for (const program of Object.values(programs)) {
    if (!existsSync(program)) throw new Error(`there is no ${program}: set FVD_BUILD to a build of fvd, fvdctl and fvd-sim`);
  }
  const folder = mkdtempSync(join(tmpdir(), "fvd-page-"));
  const memory = mkdtempSync("/dev/shm/fvd-page-");
  const at = (name) => join(folder, name);
  const motions = join(memory, "motion.txt");
  let sim;
  let fvd;
  const stop = async () => {
    await ended(fvd);  // fvd first: it says goodbye to camera and stage while they are there
    await ended(sim);
    for (const each of [folder, memory]) rmSync(each, { recursive: true, force: true });
  };
  try {
    const tokens = ["administer", "operate"].map((role) =>
      execFileSync(programs.ctl, ["token", "new", `page-${role}`, role], { encoding: "utf8", stdio: ["ignore", "pipe", "ignore"] }).trim().split("\n"));
    writeFileSync(at("tokens"), tokens.map(([, line]) => `${line}\n`).join(""), { mode: 0o600 });
    cpSync(join(root, "config/recipes"), at("recipes"), { recursive: true });
    for (const [id, document] of Object.entries(recipes)) writeFileSync(at(`recipes/${id}.json`), JSON.stringify(document));

    sim = run(programs.sim, ["run", "--world", join(root, `sim/worlds/${world}.json`), "--plant", join(root, `sim/plants/${plant}.json`),
      "--camera-address", "auto", "--stage-port", "0", "--ready-file", at("sim.json"), "--motion-log", motions], at("sim.log"));
    const { camera_address, stage_port } = await started(sim, "fvd-sim", at("sim.log"), () => readJson(at("sim.json")));
    const port = await freePort();
    const url = `http://127.0.0.1:${port}`;
    const call = caller(url, tokens[0][0]);
    const all = { "camera.address": camera_address, "stage.port": stage_port, "rpc.port": 0, "http.port": port,
      "rpc.token_file": at("tokens"), "paths.state_dir": at("state"), "paths.runtime_dir": at("run"), "paths.recipe_dir": at("recipes"), ...settings };
    const options = ["--config", join(root, "config/fvd-sim.json"), ...Object.entries(all).flatMap(([key, value]) => ["--set", `${key}=${value}`])];
    const startDaemon = async () => {
      fvd = run(programs.fvd, options, at("fvd.log"));
      await started(fvd, "fvd", at("fvd.log"), () => call("system.state").then(({ ready }) => ready, () => false));
    };
    const restart = async ({ signal, between } = {}) => {
      await ended(fvd, signal);
      await between?.(at("state"));
      await startDaemon();
    };
    await startDaemon();
    return { url, token: tokens[0][0], operator: tokens[1][0], call, stop, state: at("state"), motions, options, fvd: () => fvd, restart };
  } catch (error) {
    await stop();
    throw error;
  }
}

// Scans parts, so that the pages have something to show; the ids of the jobs. part_id: of each; absent = a number.
export async function scan(call, { recipe = "groove", parts = 1, part_id } = {}) {
  const ids = [];
  for (let i = 0; i < parts; ++i) {
    const { newest_seq } = await call("job.latest", { client: "harness" });
    const { job_id } = await call("job.start", { client: "harness", seq: newest_seq + 1, part_id: part_id ?? `part-${newest_seq + 1}`, recipe });
    await until(`job ${job_id}`, async () => (await call("job.status", { job_id })).done, 120000);
    ids.push(job_id);
  }
  await until("ready", async () => (await call("system.state")).ready);
  return ids;
}
