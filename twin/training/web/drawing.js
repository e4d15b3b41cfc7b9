// Keeps the page awake while a processor draws it.
//
// Without a graphics card the browser waits in the page's own thread until the processor has drawn
// a frame, half a second and more, and hears no press in that time. Here the page draws onto a sheet
// that is not shown, shows it when it is ready, and rests before it begins another. With a graphics
// card nothing is changed.
(() => {
  "use strict";

  const PROCESSOR = /swiftshader|llvmpipe|softpipe|software|basic render/i;
  const LOOK_MS = 4;
  // Of the time that a frame took: then the processor is the machine's, and the press's.
  const REST = 1.0;
  const PRESS_MS = 100; // So long after a press no frame begins: the processor is the machine's.
  const ALREADY = new Set([WebGL2RenderingContext.ALREADY_SIGNALED, WebGL2RenderingContext.CONDITION_SATISFIED]);

  const plain = HTMLCanvasElement.prototype.getContext;
  const next = window.requestAnimationFrame.bind(window);
  let sheet = null;
  let gl = null;
  let card = false;

  function onSheet(canvas, wishes) {
    sheet = new OffscreenCanvas(canvas.width, canvas.height);
    gl = sheet.getContext("webgl2", wishes);
    const names = gl && gl.getExtension("WEBGL_debug_renderer_info");
    card = !names || !PROCESSOR.test(gl.getParameter(names.UNMASKED_RENDERER_WEBGL));
    if (card) {
      gl?.getExtension("WEBGL_lose_context")?.loseContext();
      return;
    }
    for (const side of ["width", "height"])
      Object.defineProperty(canvas, side, { get: () => sheet[side], set: (value) => { sheet[side] = value; } });
    const shown = plain.call(canvas, "bitmaprenderer");
    window.requestAnimationFrame = (draw) => next((time) => frame(draw, time, shown));
  }

  let pressed = -Infinity;
  function press() {
    const now = performance.now();
    if (now - pressed > 3 * PRESS_MS) pressed = now; // Whoever types sees it too.
  }
  for (const kind of ["pointerdown", "keydown"]) window.addEventListener(kind, press, true);

  let busy = false;
  function frame(draw, time, shown) {
    if (busy || performance.now() - pressed < PRESS_MS) return next((later) => frame(draw, later, shown));
    const began = performance.now();
    draw(time);
    const drawn = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    if (drawn === null) return; // The context is lost: nothing will be drawn any more.
    gl.flush();
    busy = true;
    const look = () => {
      if (!gl.isContextLost() && !ALREADY.has(gl.clientWaitSync(drawn, 0, 0))) return setTimeout(look, LOOK_MS);
      gl.deleteSync(drawn);
      shown.transferFromImageBitmap(sheet.transferToImageBitmap());
      setTimeout(() => { busy = false; }, REST * (performance.now() - began));
    };
    setTimeout(look, LOOK_MS);
  }

  HTMLCanvasElement.prototype.getContext = function (kind, wishes) {
    if (kind !== "webgl2" || this.id !== "canvas" || card) return plain.call(this, kind, wishes);
    if (gl === null) onSheet(this, wishes);
    return card ? plain.call(this, kind, wishes) : gl;
  };
})();
