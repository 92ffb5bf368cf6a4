#!/usr/bin/env python3
"""The example of nginx before the operator page: nginx reads it, it agrees with its part of fvd's configuration, and what
pages rely on comes through it. nginx listens on unix sockets here: no port is fixed, none needs rights.

reverse_proxy_test.py SYSTEMD_FOLDER BUILD : BUILD/nginx has an nginx where none is installed (tests/run.sh)
Exits with 1 and the reason where something is wrong, with 77 where nginx or openssl is missing.
"""
import http.client
import json
import os
import queue
import re
import shutil
import socket
import socketserver
import ssl
import subprocess
import sys
import tempfile
import threading
import time

SKIPPED = 77
PATIENCE_S = 30
PING_PERIOD_S = 15  # daemon/events/event_resource.cpp
LONGEST_CALL_S = 300  # daemon/api/methods/device_task.cpp
FRAME = """daemon off;
master_process off;
pid {folder}/pid;
events {{}}
http {{
  access_log off;
  client_body_temp_path {folder}/body;
  proxy_temp_path {folder}/proxy;
  fastcgi_temp_path {folder}/fastcgi;
  uwsgi_temp_path {folder}/uwsgi;
  scgi_temp_path {folder}/scgi;
  include {folder}/page.conf;
}}
"""


def expect(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")


def skip(why):
    print(f"skipped: {why}")
    sys.exit(SKIPPED)


def find_nginx(build):
    for each in (shutil.which("nginx"), "/usr/sbin/nginx", os.path.join(build, "nginx/usr/sbin/nginx")):
        if each and os.access(each, os.X_OK):
            if subprocess.run([each, "-v"], capture_output=True, check=False).returncode == 0:
                return each
    return None


def without_comments(text, mark):
    return re.sub(rf"(^|\s){mark}.*", "", text, flags=re.M)


def agrees(conf, part):
    """The names, the port and the times of both files, as people would compare them."""
    conf = without_comments(conf, "#")
    http_part = json.loads(without_comments(part, "//"))["http"]
    names = {each["name"] for each in http_part["hosts"]}
    expect(set(re.findall(r"server_name\s+(\S+);", conf)) == names, f"server_name and http.hosts differ: {names}")
    upstream = f"{http_part['address']}:{http_part['port']}"
    expect(re.findall(r"^\s*server\s+([^{\s]+);", conf, re.M) == [upstream], f"the upstream is not {upstream}")
    expect(set(re.findall(r"proxy_pass\s+(\S+);", conf)) == {"http://fvd"}, "a call goes elsewhere")
    expect("proxy_set_header Host $http_host;" in conf, "fvd is not told the name that the browser called")
    blocks = dict(re.findall(r"location\s+(?:=\s+)?(\S+)\s*\{(.*?)\}", conf, re.S))
    for path in ("/api/v1/events", "/api/v1/preview.jpg"):
        expect("proxy_buffering off;" in blocks.get(path, ""), f"{path} is held back in a buffer")
    patience = {path: int(match[1]) for path, block in blocks.items()
                if (match := re.search(r"proxy_read_timeout\s+(\d+)s;", block))}
    expect(patience["/api/v1/events"] > 2 * PING_PERIOD_S, "a stream ends between two pings")
    expect(patience["/api/jsonrpc"] > LONGEST_CALL_S, "a long call ends before fvd answers it")


def make_certificate(folder, name):
    files = {"key": os.path.join(folder, "page.key"), "pem": os.path.join(folder, "page.pem")}
    made = subprocess.run(
        ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", "2",
         "-subj", f"/CN={name}", "-addext", f"subjectAltName=DNS:{name}", "-keyout", files["key"], "-out", files["pem"]],
        capture_output=True, text=True, check=False)
    expect(made.returncode == 0, f"openssl: {made.stderr}")
    return files["pem"]


def write_conf(folder, conf):
    """The example with files and sockets of the folder in place of those of a real machine: (plain, encrypted) sockets."""
    sockets = []

    def listen_at(match):
        sockets.append((match[1], os.path.join(folder, f"listen-{len(sockets)}")))
        return f"listen unix:{sockets[-1][1]}"

    conf = re.sub(r"listen (?:\[::\]:)?(80|443)\b", listen_at, conf)
    expect([port for port, _ in sockets] == ["80", "80", "443", "443"], "it does not listen on 80 and 443, IPv4 and IPv6")
    conf = conf.replace("/etc/ssl/fvd/", folder + "/")
    conf = re.sub(r"(?m)^(\s*server) 127\.0\.0\.1:\d+;", rf"\1 unix:{folder}/fvd;", conf)
    with open(os.path.join(folder, "page.conf"), "w", encoding="utf-8") as file:
        file.write(conf)
    with open(os.path.join(folder, "nginx.conf"), "w", encoding="utf-8") as file:
        file.write(FRAME.format(folder=folder))
    return sockets[0][1], sockets[2][1]


class Upstream(socketserver.ThreadingMixIn, socketserver.UnixStreamServer):
    """In fvd's place: says what reached it; of a stream it sends the second event when it is told to."""
    daemon_threads = True

    def __init__(self, path):
        self.heads = queue.Queue()
        self.connections = 0
        self.go_on = threading.Event()
        super().__init__(path, UpstreamHandler)


class UpstreamHandler(socketserver.StreamRequestHandler):
    def handle(self):
        self.server.connections += 1
        while line := self.rfile.readline():
            fields = {}
            while (field := self.rfile.readline().strip()):
                name, value = field.decode().split(":", 1)
                fields[name.lower()] = value.strip()
            self.rfile.read(int(fields.get("content-length", 0)))
            self.server.heads.put((line.decode().split(), fields))
            if b"/events" in line:
                self.stream()
                return
            self.wfile.write(b"HTTP/1.1 200 OK\r\nContent-Type: text/plain\r\nContent-Length: 2\r\n"
                             b"Content-Security-Policy: default-src 'self'\r\n\r\nok")

    def stream(self):
        self.wfile.write(b"HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nTransfer-Encoding: chunked\r\n\r\n")
        for text in (b"data: 1\n\n", b"data: 2\n\n"):
            self.wfile.write(b"%x\r\n%s\r\n" % (len(text), text))
            self.server.go_on.wait(PATIENCE_S)
        self.wfile.write(b"0\r\n\r\n")


class ThroughProxy(http.client.HTTPConnection):
    def __init__(self, path, name, trusted=None):
        super().__init__(name, timeout=PATIENCE_S)
        self.path, self.trusted = path, trusted

    def connect(self):
        self.sock = socket.socket(socket.AF_UNIX)
        self.sock.settimeout(PATIENCE_S)
        self.sock.connect(self.path)
        if self.trusted:
            self.sock = ssl.create_default_context(cafile=self.trusted).wrap_socket(self.sock, server_hostname=self.host)


def redirects(plain, name):
    line = ThroughProxy(plain, name)
    line.request("GET", "/jobs/4711?a=b")
    answer = line.getresponse()
    expect((answer.status, answer.getheader("Location")) == (301, f"https://{name}/jobs/4711?a=b"),
           f"http is not led to https: {answer.status} {answer.getheader('Location')}")


def passes_calls(line, upstream, name):
    for _ in range(2):
        line.request("POST", "/api/jsonrpc", "{}", {"Content-Type": "application/json", "Origin": f"https://{name}",
                                                    "Authorization": "Bearer secret", "Sec-Fetch-Site": "same-origin"})
        answer = line.getresponse()
        expect(answer.status == 200 and answer.read() == b"ok", f"a call is answered with {answer.status}")
        expect(answer.getheader("Content-Security-Policy") == "default-src 'self'", "the page's rules are lost")
        request, fields = upstream.heads.get(timeout=PATIENCE_S)
        expect(request == ["POST", "/api/jsonrpc", "HTTP/1.1"], f"fvd gets {request}")
        expect(fields["origin"] == "https://" + fields["host"], f"Origin and Host differ: {fields}")
        expect(fields["authorization"] == "Bearer secret" and fields["sec-fetch-site"] == "same-origin", f"lost: {fields}")
    expect(upstream.connections == 1, "each call has a connection of its own")
    line.request("POST", "/api/jsonrpc", b" " * (2 << 20), {"Content-Type": "application/json"})
    answer = line.getresponse()
    expect(answer.status == 413, f"a body of 2 MiB is answered with {answer.status}")


def passes_events(line, upstream):
    line.request("GET", "/api/v1/events", headers={"Last-Event-ID": "1-7"})
    answer = line.getresponse()
    expect(answer.readline() == b"data: 1\n", "the first event does not come")  # the second was not sent: nothing is held
    _, fields = upstream.heads.get(timeout=PATIENCE_S)
    expect(fields.get("last-event-id") == "1-7", "the reader's place is lost")
    upstream.go_on.set()
    expect(b"data: 2" in answer.read(), "the second event does not come")


def main():
    folder, build = sys.argv[1:]
    with open(os.path.join(folder, "fvd-nginx.conf"), encoding="utf-8") as file:
        conf = file.read()
    with open(os.path.join(folder, "fvd-nginx.json"), encoding="utf-8") as file:
        part = file.read()
    agrees(conf, part)
    nginx = find_nginx(build)
    if not nginx:
        skip("the files agree; there is no nginx to read them (apt-get install nginx-light, or tests/run.sh)")
    if not shutil.which("openssl"):
        skip("the files agree; openssl is not installed")
    name = re.search(r"server_name\s+(\S+);", conf)[1]
    with tempfile.TemporaryDirectory(prefix="fvd-nginx-") as work:
        trusted = make_certificate(work, name)
        plain, encrypted = write_conf(work, conf)
        command = [nginx, "-p", work, "-e", "stderr", "-c", os.path.join(work, "nginx.conf")]
        read = subprocess.run([*command, "-t"], capture_output=True, text=True, check=False)
        expect(read.returncode == 0, f"nginx -t: {read.stderr}")
        with Upstream(os.path.join(work, "fvd")) as upstream:
            threading.Thread(target=upstream.serve_forever, daemon=True).start()
            with open(os.path.join(work, "log"), "w+", encoding="utf-8") as log:
                proxy = subprocess.Popen(command, stderr=log, stdin=subprocess.DEVNULL)
                try:
                    wait_until_it_listens(encrypted, proxy, log)
                    redirects(plain, name)
                    passes_calls(ThroughProxy(encrypted, name, trusted), upstream, name)
                    passes_events(ThroughProxy(encrypted, name, trusted), upstream)
                finally:
                    proxy.terminate()
                    proxy.wait(PATIENCE_S)
                    upstream.shutdown()
    print("passed")


def wait_until_it_listens(path, proxy, log):
    while proxy.poll() is None:
        with socket.socket(socket.AF_UNIX) as line:
            if line.connect_ex(path) == 0:
                return
        time.sleep(0.01)
    log.seek(0)
    expect(False, f"nginx ended: {log.read()}")


main()
