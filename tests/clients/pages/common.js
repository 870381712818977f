// Shared by the pages: what is drawn, as numbers.

/** What a canvas shows, RGBA. It keeps its drawing buffer. */
function pixelsOf(canvas) {
  const copy = document.createElement('canvas');
  copy.width = canvas.width;
  copy.height = canvas.height;
  const context = copy.getContext('2d');
  context.drawImage(canvas, 0, 0);
  return context.getImageData(0, 0, copy.width, copy.height).data;
}

/** Pixels of a canvas that differ clearly from its corner's. */
export function drawnPixels(canvas) {
  const data = pixelsOf(canvas);
  let count = 0;
  for (let i = 0; i < data.length; i += 4)
    if (Math.abs(data[i] - data[0]) + Math.abs(data[i + 1] - data[1]) + Math.abs(data[i + 2] - data[2]) > 24) ++count;
  return count;
}

/** Shares of the drawn pixels that have the colours which paint.mjs gave roofs, walls and undersides. */
export function drawnBands(canvas) {
  const bands = { red: [220, 30, 30], green: [30, 160, 40], blue: [30, 40, 220] };
  const data = pixelsOf(canvas), share = { red: 0, green: 0, blue: 0, pixels: 0 };
  for (let i = 0; i < data.length; i += 4) {
    const distance = (rgb) => Math.max(...rgb.map((value, k) => Math.abs(value - data[i + k])));
    if (distance([data[0], data[1], data[2]]) <= 8) continue;
    ++share.pixels;
    for (const [name, rgb] of Object.entries(bands)) if (distance(rgb) <= 20) ++share[name];
  }
  for (const name of Object.keys(bands)) share[name] /= Math.max(1, share.pixels);
  return share;
}

/**
 * Resolves when `settled()` held for ten frames and half a second on end: CesiumJS waits 0.2 s after a camera's move before it asks
 * for tiles at the view's edge. Rejects after `limit` ms.
 */
export async function settle(settled, limit = 180000) {
  const begin = performance.now();
  for (let frames = 0, since = begin; frames < 10 || performance.now() < since + 500; ++frames) {
    await new Promise((done) => requestAnimationFrame(done));
    if (!settled()) {
      frames = 0;
      since = performance.now();
    }
    if (performance.now() > begin + limit) throw new Error('not settled in time');
  }
}

/** The first answer of `ask(x, y)`, both −0.8 … 0.8 of the view, over a lattice of places to click. */
export function firstOf(ask) {
  for (let y = -0.8; y < 0.9; y += 0.2)
    for (let x = -0.8; x < 0.9; x += 0.2) {
      const answer = ask(x, y);
      if (answer) return answer;
    }
  return null;
}
