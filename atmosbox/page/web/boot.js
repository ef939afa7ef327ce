// Turns the scripts that stand in this page as text into modules, in the order in which they stand.
//
// A page that was opened from disk may not import a module from another file. What it may import is a blob that it made
// itself, so every script becomes one, and the names it imports are replaced by the addresses of the blobs before it.
(() => {
  "use strict";
  const address = { };
  const known = (name) => address[name] ?? address[name.replace(/^\.\//, "")];
  const imports = /(\bfrom\s*|\bimport\s*)(["'])([\w./-]+)\2/g;
  for (const script of document.querySelectorAll("script[data-module]")) {
    const name = script.dataset.module;
    const text = script.textContent.replace(imports, (all, word, quote, wanted) =>
      known(wanted) ? `${word}"${known(wanted)}"` : all);
    address[name] = URL.createObjectURL(new Blob([text], { type: "text/javascript" }));
    if (name === "three.module.min.js") address.three = address[name];
  }
  const fail = (reason) => {
    const line = document.createElement("p");
    line.className = "failure";
    line.textContent = `${document.body.dataset.failure} (${reason})`;
    document.body.append(line);
    console.error(reason);
  };
  import(address[document.getElementById("entry").textContent]).then((module) => module.begin()).catch(fail);
})();
