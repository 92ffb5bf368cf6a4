#!/usr/bin/python3
"""A page of another origin, in a real Chromium, that does what it can to move the stage: fetch, form, beacon, WebSocket.

usage: hostile_page.py BUILD   (folder of the build; needs `chromium`)
The daemon has no devices, yet tells and writes down whatever is asked of it. Last line: one JSON object
{"chromium": true, "attempts": N, "arrived": N, "unauthorised_accepted": N}.
"""

import http.server
import json
import os
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import threading
import time

SOURCES = pathlib.Path(__file__).resolve().parents[3]
PATIENCE_S = 90

PAGE = """<!doctype html><title>a page</title><body><script>
const ports = PORTS, token = TOKEN, home = HOME;
const calls = [
  {jsonrpc: '2.0', id: 1, method: 'stage.stop', params: {}},
  {jsonrpc: '2.0', id: 2, method: 'job.start', params: {seq: 1, part_id: 'p', recipe: 'r'}},
  {jsonrpc: '2.0', method: 'control.release'}];
const lines = calls.map(c => JSON.stringify(c));
const told = [];
const within = (promise, ms) => Promise.race([promise, new Promise(end => setTimeout(() => end('no answer'), ms))]);
async function attempt(what, act) {
  let outcome;
  try { outcome = String(await within(act(), 3000)); } catch (error) { outcome = String(error); }
  told.push([what, outcome]);
}
const post = (url, options) => fetch(url, {method: 'POST', ...options}).then(r => r.type + ' ' + r.status);
function form(url, text) {
  return new Promise(end => {
    const frame = document.createElement('iframe');
    frame.name = 'f' + Math.random();
    const sender = document.createElement('form');
    Object.assign(sender, {method: 'POST', action: url, enctype: 'text/plain', target: frame.name});
    const field = document.createElement('input');
    // text/plain is sent as name=value and a line's end: the line is the name, the equals sign stands inside a text.
    field.name = '\\r\\n' + text + '\\r\\n' + text.slice(0, -1) + ',"x":"';
    field.value = '"}\\r\\n' + text + '\\r\\n';
    sender.append(field);
    document.body.append(frame, sender);
    frame.onload = () => end('loaded');
    sender.submit();
  });
}
function web_socket(url) {
  return new Promise(end => {
    const socket = new WebSocket(url);
    socket.onopen = () => { lines.forEach(line => socket.send(line + '\\n')); };
    socket.onmessage = message => end('answer ' + message.data);
    socket.onerror = () => end('error');
    socket.onclose = () => end('closed');
  });
}
async function all() {
  for (const host of ['127.0.0.1', 'localhost', 'rebound.example']) {
    for (const port of ports) {
      const url = 'http://' + host + ':' + port + '/api/jsonrpc';
      for (const line of lines) {
        await attempt('plain', () => post(url, {mode: 'no-cors', body: line + '\\n'}));
        await attempt('lines', () => post(url, {mode: 'no-cors', body: '\\n' + line + '\\n'}));
        await attempt('json', () => post(url, {headers: {'Content-Type': 'application/json'}, body: line}));
        await attempt('token', () => post(url, {
            headers: {'Content-Type': 'application/json', 'Authorization': 'Bearer ' + token}, body: line}));
        await attempt('login', () => post(url, {mode: 'no-cors', body:
            '\\n{"jsonrpc":"2.0","id":0,"method":"session.login","params":{"token":"' + token + '"}}\\n' + line + '\\n'}));
        await attempt('get', () => fetch(url + '?' + encodeURIComponent(line), {mode: 'no-cors'}).then(r => r.type));
        await attempt('form', () => form(url, line));
        await attempt('beacon', async () => navigator.sendBeacon(url, new Blob([line + '\\n'], {type: 'text/plain'})));
      }
      await attempt('websocket', () => web_socket('ws://' + host + ':' + port + '/api/jsonrpc'));
      await attempt('websocket', () => web_socket('ws://' + host + ':' + port + '/'));
    }
  }
  await fetch(home + '/done', {method: 'POST', mode: 'no-cors', body: JSON.stringify(told)});
}
all();
</script></body>
"""


def serve_page(page):
    """The page on a port of its own; what it tells at its end comes into the list."""
    done, reports = threading.Event(), []

    class Handler(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            self.send_response(200)
            self.send_header("Content-Type", "text/html")
            self.end_headers()
            self.wfile.write(page().encode())

        def do_POST(self):
            reports.extend(json.loads(self.rfile.read(int(self.headers["Content-Length"]))))
            self.send_response(204)
            self.end_headers()
            done.set()

        def log_message(self, *_):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return server, done, reports


def ask(socket_file, method, params):
    """One call by the unix socket, as who administers."""
    with socket.socket(socket.AF_UNIX) as client:
        client.settimeout(20)
        client.connect(str(socket_file))
        client.sendall(json.dumps({"jsonrpc": "2.0", "id": 1, "method": method, "params": params}).encode() + b"\n")
        text = b""
        while not text.endswith(b"\n"):
            text += client.recv(65536)
    return json.loads(text)


def wait_for(what, found):
    deadline = time.monotonic() + PATIENCE_S
    while time.monotonic() < deadline:
        result = found()
        if result:
            return result
        time.sleep(0.05)
    sys.exit(f"hostile_page.py: {what} did not come within {PATIENCE_S} s")


def start_daemon(build, folder):
    token, line = subprocess.run([build / "daemon/ctl/fvdctl", "token", "new", "kiosk", "operate"], check=True,
                                 capture_output=True, text=True).stdout.split("\n")[:2]
    (folder / "tokens").write_text(line + "\n")
    (folder / "recipes").mkdir()
    (folder / "fvd.json").write_text(json.dumps({
        # What loopback may at most: whatever comes in by either port has every right.
        "rpc": {"port": 0, "token_file": "tokens", "loopback_role": "administer"},
        "http": {"port": 0},
        "camera": {"driver": "aravis", "address": "127.0.0.9"},
        "stage": {"driver": "modbus", "profile": str(SOURCES / "config/drives/oriental-az.json"),
                  "address": "127.0.0.1", "port": 1, "min_um": -100, "max_um": 100},
        "paths": {"state_dir": str(folder / "state"), "runtime_dir": str(folder / "run"),
                  "recipe_dir": "recipes"}}))
    log = open(folder / "log", "w", encoding="utf-8")
    daemon = subprocess.Popen([build / "daemon/fvd", "--config", folder / "fvd.json"], stdout=log, stderr=log)

    def port_of(pattern):
        found = re.search(pattern, (folder / "log").read_text(encoding="utf-8"))
        if daemon.poll() is not None:
            sys.exit("hostile_page.py: fvd ended: " + (folder / "log").read_text(encoding="utf-8")[-2000:])
        return found and int(found.group(1))

    http_port = wait_for("the HTTP port", lambda: port_of(r"HTTP on 127\.0\.0\.1:(\d+)"))
    rpc_port = wait_for("the port", lambda: port_of(r"listening on 127\.0\.0\.1:(\d+)"))
    return daemon, [rpc_port, http_port], token


def browse(folder, url):
    return subprocess.Popen(
        ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-dev-shm-usage",
         "--host-resolver-rules=MAP rebound.example 127.0.0.1", f"--user-data-dir={folder / 'chromium'}", url],
        stdout=subprocess.DEVNULL, stderr=open(folder / "chromium.log", "w", encoding="utf-8"),
        env={**os.environ, "HOME": str(folder)})


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    if not shutil.which("chromium"):
        print("hostile_page.py: skipped, there is no chromium here (apt-get install chromium)", file=sys.stderr)
        print(json.dumps({"chromium": False, "attempts": 0, "arrived": 0, "unauthorised_accepted": 0}))
        return
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        daemon, ports, token = start_daemon(build, folder)
        try:
            page = {"text": ""}
            server, done, reports = serve_page(lambda: page["text"])
            home = f"http://127.0.0.1:{server.server_address[1]}"
            page["text"] = (PAGE.replace("PORTS", json.dumps(ports)).replace("TOKEN", json.dumps(token))
                            .replace("HOME", json.dumps(home)))
            (folder / "page.html").write_text(page["text"])
            for url in (home + "/", (folder / "page.html").as_uri()):
                done.clear()
                browser = browse(folder, url)
                try:
                    if not done.wait(PATIENCE_S * 4):
                        sys.exit("hostile_page.py: the page did not come to its end: " +
                                 (folder / "chromium.log").read_text(encoding="utf-8")[-2000:])
                finally:
                    browser.terminate()
                    browser.wait()
            socket_file = folder / "run/fvd.sock"
            own = ask(socket_file, "stage.stop", {})
            entries = ask(socket_file, "audit.list", {"most": 1000})["result"]["entries"]
        finally:
            daemon.terminate()
            daemon.wait()
        log = (folder / "log").read_text(encoding="utf-8")
    entries = [entry for entry in entries if entry["what"] != "configuration.load"]
    foreign = [entry for entry in entries if not entry["peer"].startswith("process ")]
    answered = [report for report in reports if report[1].startswith(("answer", "cors 200", "basic 200"))]
    if "result" not in own or len(entries) != len(foreign) + 1:
        sys.exit(f"hostile_page.py: the call that must be written down is not: {own} {entries}")
    for entry in foreign + answered:
        print(f"accepted: {entry}", file=sys.stderr)
    arrived = len(re.findall(r"HTTP from .* was refused", log))
    if arrived == 0:
        sys.exit("hostile_page.py: nothing that the page sent has reached the HTTP port: this proves nothing")
    print(json.dumps({"chromium": True, "attempts": len(reports), "arrived": arrived,
                      "unauthorised_accepted": len(foreign) + len(answered)}))


main()
