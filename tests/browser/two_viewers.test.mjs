// Two viewers on a page of another site, side by side, each with a server of its own.
import assert from "node:assert/strict";
import { createServer } from "node:http";
import { after, test } from "node:test";
import { axeFaults } from "./support/axe.mjs";
import { control, when } from "./support/browser.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const names = ["left", "right"];
let servers;
let page;

const html = () => `<!doctype html>
<html lang="en">
  <head>
    <title>Two viewers</title>
    <link rel="icon" href="favicon.svg" />
    <link rel="stylesheet" href="style.css" />
    <style>
      body { margin: 0; }
      main { display: grid; grid-template-columns: 1fr 1fr; gap: 8px; height: 100vh; }
    </style>
  </head>
  <body>
    <main>${names
      .map((name, k) => {
        const address = `${servers[k].url.replace("http", "ws")}ws?picture=light&amp;fixed`;
        return `<section class="spherule" id="${name}" aria-label="${name}" data-server="${address}"></section>`;
      })
      .join("")}</main>
    <script src="viewer.js"></script>
  </body>
</html>`;

// The site has the page, and the files of the viewer as a server sends them.
const site = createServer((request, response) => {
  if (request.url === "/") response.setHeader("Content-Type", "text/html").end(html());
  else void forward(request.url, response);
});

async function forward(path, response) {
  const answer = await fetch(new URL(path, servers[0].url));
  response.writeHead(answer.status, { "Content-Type": answer.headers.get("content-type") });
  response.end(Buffer.from(await answer.arrayBuffer()));
}

after(() => site.close());

browserSuite(async (browser) => {
  await new Promise((resolve) => site.listen(0, "127.0.0.1", resolve));
  const origin = `http://127.0.0.1:${site.address().port}`;
  const options = ["--origin", origin, "--open"];
  servers = [await serve("billiards", { options }), await serve("bounce", { options })];
  page = await browser.newPage({ viewport: { width: 1280, height: 720 } });
  page.faults = [];
  page.on("console", (message) => message.type() === "error" && page.faults.push(message.text()));
  page.on("pageerror", (error) => page.faults.push(error.message));
  await page.goto(origin);
  for (const [k, scene] of ["billiards", "bounce"].entries()) {
    await when(page, ([host, name]) => document.querySelector(`#${host} h1`)?.textContent === name, [names[k], scene]);
    await page.waitForSelector(`#${names[k]} .view:not(.empty)`);
  }
});

const inViewer = (name, id) => `#${name} ${control(id)}`;

/** Waits until the viewer shows that its server is paused, or not. */
const paused = (name, wanted) =>
  when(page, ([at, value]) => document.querySelector(at).dataset.paused === value, [inViewer(name, "pause"), wanted]);

/** The colours that the canvas of a viewer shows. */
async function colours(name) {
  const shot = await page.locator(`#${name} .view`).screenshot();
  return page.evaluate(
    async (bytes) => {
      const image = await createImageBitmap(new Blob([new Uint8Array(bytes)]));
      const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
      context.drawImage(image, 0, 0);
      const { data } = context.getImageData(0, 0, image.width, image.height);
      return new Set(new Uint32Array(data.buffer)).size;
    },
    [...shot],
  );
}

test("both viewers draw, in their own elements", async () => {
  for (const name of names) {
    assert.ok((await colours(name)) > 500, name);
    const [host, view] = [`#${name}`, `#${name} .view`];
    assert.deepEqual(await page.locator(view).boundingBox(), await page.locator(host).boundingBox());
  }
  const outside = await page.evaluate(() =>
    Array.from(document.querySelectorAll(".page *"), (element) => {
      const [box, host] = [element, element.closest(".spherule")].map((one) => one.getBoundingClientRect());
      const isSeen = element.checkVisibility({ visibilityProperty: true }) && box.width > 1 && box.height > 1;
      const isBeside = box.right <= host.left || box.left >= host.right;
      return isSeen && isBeside ? element.outerHTML : "";
    }).filter(Boolean),
  );
  assert.deepEqual(outside, []);
  assert.deepEqual(page.faults, []);
});

test("a key reaches only the viewer that has the focus, else the one under the pointer", async () => {
  await page.focus(inViewer("right", "picture"));
  await page.mouse.move(320, 360);
  await page.keyboard.press("Space");
  await paused("right", "true");
  // Commands of a viewer are answered in their order, so an answer to the key would be before the one to the click.
  await page.click(inViewer("left", "step"));
  await when(page, () => spherule.reports.length > 0);
  assert.match(await page.evaluate(() => spherule.reports[0].name), /step/i);
  await page.evaluate(() => document.activeElement.blur());
  await page.mouse.move(320, 360);
  await page.keyboard.press("Space");
  await paused("left", "false");
});

test("a file that is dropped on a viewer is for that viewer", async () => {
  await page.evaluate(() => {
    const transfer = new DataTransfer();
    transfer.items.add(new File(["text"], "notes.txt"));
    const event = new DragEvent("drop", { dataTransfer: transfer, bubbles: true, cancelable: true });
    document.querySelector("#right .view").dispatchEvent(event);
  });
  const refused = (name) => page.locator(`#${name} .toast`, { hasText: "notes.txt" });
  await refused("right").waitFor();
  assert.equal(await refused("left").count(), 0);
});

test("each viewer has a theme of its own", async () => {
  await page.click(inViewer("right", "panel-toggle"));
  await page.selectOption(inViewer("right", "theme"), { label: "Dark" });
  const ground = (name) => page.evaluate((at) => getComputedStyle(document.querySelector(at)).backgroundColor, name);
  assert.notEqual(await ground("#left"), await ground("#right"));
});

test("ids are unique, and axe-core finds no fault", async () => {
  await page.click(inViewer("left", "panel-toggle"));
  const twice = await page.evaluate(() => {
    const ids = Array.from(document.querySelectorAll("[id]"), ({ id }) => id);
    return ids.filter((id, k) => ids.indexOf(id) !== k);
  });
  assert.deepEqual(twice, []);
  const references = await page.evaluate(() =>
    ["for", "aria-labelledby", "aria-describedby"].flatMap((name) =>
      Array.from(document.querySelectorAll(`[${name}]`), (element) => [element, element.getAttribute(name).split(" ")])
        .filter(([element, ids]) =>
          ids.some((id) => element.closest(".spherule") !== document.getElementById(id)?.closest(".spherule")),
        )
        .map(([, ids]) => ids.join(" ")),
    ),
  );
  assert.deepEqual(references, []);
  assert.deepEqual(await axeFaults(page), []);
});
