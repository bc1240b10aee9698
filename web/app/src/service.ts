// Keeps the files of one version, so that the page works without a network. File names hold their content's hash; a new version
// waits until no page of the old one is open, so that no page is made of two.

declare const VERSION: string;
declare const FILES: string[];

const worker = globalThis as unknown as ServiceWorkerGlobalScope;

worker.addEventListener("install", (event) => {
  event.waitUntil(caches.open(VERSION).then((cache) => cache.addAll(FILES)));
});

worker.addEventListener("activate", (event) => {
  const old = async () => {
    for (const name of await caches.keys()) if (name.startsWith("jurist-") && name !== VERSION) await caches.delete(name);
    await worker.clients.claim();
  };
  event.waitUntil(old());
});

worker.addEventListener("fetch", (event) => {
  const url = new URL(event.request.url);
  if (event.request.method !== "GET" || url.origin !== worker.location.origin) return;
  const page = event.request.mode === "navigate";
  const answer = async () => {
    const cache = await caches.open(VERSION);
    const kept = await cache.match(page ? "index.html" : event.request, { ignoreSearch: page });
    return kept ?? fetch(event.request);
  };
  event.respondWith(answer());
});
