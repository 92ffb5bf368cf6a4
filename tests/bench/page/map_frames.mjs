// Frames a second of the 2D map while it is held and moved. A frame is one that the page drew for a new view and whose
// pixels were there: one of them is read before the next is asked for.

async function middleOf(page, selector) {
  const { x, y, width, height } = await page.locator(selector).boundingBox();
  return { x: x + width / 2, y: y + height / 2, width, height };
}

// how: "drag" or "zoom". The pointer is down by the debugger, for a page may only hold one that is; its moves are made in
// the page, one a frame, so that the debugger's line is no part of the time.
export async function framesWhile(page, how, time_ms) {
  const middle = await middleOf(page, ".map-stage");
  await page.locator(".map-stage").focus();
  // Away from the profile's line, whose ends can be held too.
  const at = { x: middle.x, y: middle.y - middle.height / 4 };
  await page.mouse.move(at.x, at.y);
  if (how === "drag") await page.mouse.down();
  const drive = async ({ kind, begin, wanted_ms }) => {
    const stage = document.querySelector(".map-stage");
    const canvas = document.querySelector(".map-canvas");
    const context = canvas.getContext("2d");
    const probe = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
    let drawn = 0;
    context.clearRect = (...box) => {  // the first call of each drawing
      ++drawn;
      return CanvasRenderingContext2D.prototype.clearRect.apply(context, box);
    };
    const act = (i) => {
      if (kind === "zoom") {
        const deltaY = i % 40 < 20 ? -40 : 40;
        stage.dispatchEvent(new WheelEvent("wheel", { bubbles: true, cancelable: true, ctrlKey: true, deltaY, clientX: begin.x, clientY: begin.y }));
      } else {
        const clientX = begin.x + 80 * Math.sin(i / 10);
        const clientY = begin.y + 40 * Math.cos(i / 10);
        stage.dispatchEvent(new PointerEvent("pointermove", { bubbles: true, pointerId: 1, pointerType: "mouse", buttons: 1, clientX, clientY }));
      }
    };
    const begun = performance.now();
    let frames = 0;
    for (let i = 0; performance.now() - begun < wanted_ms; ++i) {
      const before = drawn;
      act(i);
      const asked = performance.now();
      while (drawn === before) {
        if (performance.now() - asked > 5000) throw new Error("the map draws nothing");
        await new Promise(requestAnimationFrame);
      }
      probe.drawImage(canvas, canvas.width / 2, canvas.height / 2, 1, 1, 0, 0, 1, 1);
      probe.getImageData(0, 0, 1, 1);
      ++frames;
    }
    const passed_ms = performance.now() - begun;
    delete context.clearRect;
    return (1000 * frames) / passed_ms;
  };
  try {
    return await page.evaluate(drive, { kind: how, begin: at, wanted_ms: time_ms });
  } finally {
    if (how === "drag") await page.mouse.up();
  }
}
