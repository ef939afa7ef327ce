// Turns the scripts that this page contains as text into modules, in their order on the page.
//
// A page that was opened from disk may not import a module from another file, but it may import a blob that it made
// itself. So each script becomes a blob, and the names of its imports are replaced by the addresses of earlier blobs.
// Libraries are compressed, and in base64.
(() => {
  "use strict";
  const address = { };
  const known = (name) => address[name] ?? address[name.replace(/^\.\//, "")];
  const imports = /(\bfrom\s*|\bimport\s*)(["'])([\w./-]+)\2/g;
  const unpacked = (text) => new Response(new Blob([Uint8Array.from(atob(text), (sign) => sign.charCodeAt(0))])
    .stream().pipeThrough(new DecompressionStream("gzip"))).text();
  const begin = async () => {
    for (const script of document.querySelectorAll("script[data-module]")) {
      const name = script.dataset.module;
      const source = script.hasAttribute("data-packed") ? await unpacked(script.textContent) : script.textContent;
      const text = source.replace(imports, (all, word, quote, wanted) =>
        known(wanted) ? `${word}"${known(wanted)}"` : all);
      address[name] = URL.createObjectURL(new Blob([text], { type: "text/javascript" }));
      if (name === "three.module.min.js") address.three = address[name];
    }
    return (await import(address[document.getElementById("entry").textContent])).begin();
  };
  begin().catch((reason) => {
    const line = document.createElement("p");
    line.className = "failure";
    line.textContent = `${document.body.dataset.failure} (${reason})`;
    document.body.append(line);
    console.error(reason);
  });
})();
