#!/usr/bin/env python3
"""Takes pictures of pages with headless Chromium, and fails where a page asks for anything but itself.

usage: report_pictures.py PAGE.html OUT_STEM [VIEW ...]

Views: screen (default), dark, narrow (400 px), print (the style for paper, as wide as A4 leaves room for), pdf. Writes OUT_STEM_VIEW.png or .pdf. A view may
have a section, a largest height and a scale: screen:stages, screen::900, dark:verdict:700:0.5.
"""
import base64
import json
import os
import pathlib
import subprocess
import sys
import tempfile


class Chromium:
    """Headless Chromium, spoken to over a pipe (Chrome DevTools Protocol)."""

    def __init__(self, program="chromium"):
        self.profile = tempfile.TemporaryDirectory(prefix="aeroloom_chromium_")
        to_read, self.write_end = os.pipe()
        self.read_end, to_write = os.pipe()

        def take_pipes():
            # Both may lie on the numbers that the browser wants.
            command, answers = os.dup(to_read), os.dup(to_write)
            os.dup2(command, 3)
            os.dup2(answers, 4)

        self.process = subprocess.Popen(
            [program, "--headless", "--no-sandbox", "--disable-gpu", "--remote-debugging-pipe", "--no-first-run",
             "--disable-background-networking", "--hide-scrollbars", f"--user-data-dir={self.profile.name}"],
            pass_fds=(3, 4), preexec_fn=take_pipes, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_read)
        os.close(to_write)
        self.number, self.rest, self.events = 0, b"", []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Network", "Runtime", "Log"):
            self.call(domain + ".enable")

    def close(self):
        os.close(self.write_end)
        self.process.terminate()
        self.process.wait()
        os.close(self.read_end)
        self.profile.cleanup()

    def next_message(self):
        while b"\0" not in self.rest:
            read = os.read(self.read_end, 1 << 20)
            if not read:
                raise RuntimeError("Chromium has ended")
            self.rest += read
        message, self.rest = self.rest.split(b"\0", 1)
        return json.loads(message)

    def call(self, method, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if hasattr(self, "session"):
            message["sessionId"] = self.session
        os.write(self.write_end, json.dumps(message).encode() + b"\0")
        while True:
            answer = self.next_message()
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]
            self.events.append(answer)

    def load(self, url):
        self.events = []
        self.call("Page.navigate", url=url)
        while not any(event.get("method") == "Page.loadEventFired" for event in self.events):
            self.events.append(self.next_message())

    def evaluate(self, expression):
        return self.call("Runtime.evaluate", expression=expression, returnByValue=True)["result"].get("value")

    def requests(self):
        """All addresses the page has asked for, data: left out."""
        asked = [event["params"]["request"]["url"] for event in self.events
                 if event.get("method") == "Network.requestWillBeSent"]
        return [url for url in asked if not url.startswith("data:")]

    def complaints(self):
        """What stands in the console."""
        return [event["params"] for event in self.events if event.get("method") in ("Log.entryAdded", "Runtime.exceptionThrown")]

    def show(self, dark=False, paper=False, width=1200):
        scheme = [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]
        self.call("Emulation.setEmulatedMedia", media="print" if paper else "screen", features=scheme)
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=width < 500)

    def picture(self, file, section="", most=6000, scale=1.0):
        box = self.evaluate(
            f"(() => {{ const e = {'document.getElementById(%r)' % section if section else 'document.documentElement'};"
            "const r = e.getBoundingClientRect(); return [r.x + scrollX, r.y + scrollY, r.width, r.height]; })()")
        clip = {"x": max(0, box[0] - 12), "y": max(0, box[1] - 8), "width": box[2] + 24 if section else box[2],
                "height": min(most, box[3] + (16 if section else 0)), "scale": scale}
        shot = self.call("Page.captureScreenshot", format="png", clip=clip, captureBeyondViewport=True)
        pathlib.Path(file).write_bytes(base64.b64decode(shot["data"]))

    def pdf(self, file):
        pages = self.call("Page.printToPDF", printBackground=False, preferCSSPageSize=True)
        pathlib.Path(file).write_bytes(base64.b64decode(pages["data"]))


def main():
    page, stem = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2]
    browser = Chromium()
    try:
        browser.load(page.as_uri())
        for view in sys.argv[3:] or ["screen"]:
            kind, section, most, scale = (view.split(":") + [""] * 3)[:4]
            browser.show(dark=kind == "dark", paper=kind == "print", width={"narrow": 400, "print": 688}.get(kind, 1200))
            name = f"{stem}_{kind}{'_' + section if section else ''}"
            if kind == "pdf":
                browser.pdf(name + ".pdf")
            else:
                browser.picture(name + ".png", section, int(most or 6000), float(scale or 1))
            wider = browser.evaluate("document.documentElement.scrollWidth - innerWidth")
            print(f"{name}: {wider} px wider than the window" if wider > 0 else name)
        stray = [url for url in browser.requests() if url != page.as_uri()]
        if stray or browser.complaints():
            print(f"the page asked for {stray}, the console says {browser.complaints()}")
            return 1
        return 0
    finally:
        browser.close()


if __name__ == "__main__":
    sys.exit(main())
