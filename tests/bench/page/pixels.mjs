// The pixels of a picture that was taken of the page: decoded by the browser, for Node has no decoder.

// { width, height, green: per pixel 0 to 255 }. Of viridis, green rises with the height.
export async function greenOf(page, png) {
  const { width, height, text } = await page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (each) => each.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
    context.drawImage(bitmap, 0, 0);
    const { data } = context.getImageData(0, 0, bitmap.width, bitmap.height);
    let green = "";
    for (let i = 1; i < data.length; i += 4) green += String.fromCharCode(data[i]);
    return { width: bitmap.width, height: bitmap.height, text: btoa(green) };
  }, png.toString("base64"));
  return { width, height, green: Buffer.from(text, "base64") };
}
