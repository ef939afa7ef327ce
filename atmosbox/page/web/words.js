// The words of the page, in the language of whoever reads it: one table a language, in atmosbox/page/language.
//
// `word` gives what the page itself says, by a key; `phrase` what scenes and the program say, by its English words.

const TABLES = JSON.parse(document.getElementById("words")?.textContent ?? "{}");
const NUMBER = /(\d)\.(\d)/g; // the decimal point of a number

const known = (wanted) => [wanted, wanted?.slice(0, 2)].find((each) => TABLES[each]);

// The language that was asked for, or the first of the browser's that there is.
export const language = (() => {
  const asked = document.documentElement.dataset.language;
  const wanted = asked && asked !== "auto" ? [asked] : navigator.languages ?? [];
  return wanted.map(known).find(Boolean) ?? "en";
})();

const table = TABLES[language] ?? {}, english = TABLES.en ?? {};

const filled = (text, values) => text.replace(/\{(\w+)\}/g, (all, name) => values[name] ?? all);

// What the page says under a key, with values in the places of their names.
export const word = (key, values = {}) => filled(table.page?.[key] ?? english.page?.[key] ?? key, values);

// A text with numbers, as the language writes them.
export const numbers = (text) => (table.decimal && table.decimal !== "." ? text.replace(NUMBER, `$1${table.decimal}$2`) : text);

// English sentences with gaps, the longest first, as patterns.
const patterns = Object.entries(table.phrase ?? {}).filter(([text]) => text.includes("{}"))
  .toSorted(([one], [other]) => other.length - one.length)
  .map(([text, said]) => [new RegExp(`^${text.split("{}").map((part) => part.replace(/[.*+?^${}()|[\]\\]/g, "\\$&")).join("(.+?)")}$`), said]);

// What a scene or the program says, translated if the table has it; a number in it stays what it is.
export function phrase(text) {
  const plain = (text ?? "").replaceAll("\u00a0", " ");
  const exact = table.phrase?.[plain];
  if (exact !== undefined) return exact;
  for (const [pattern, said] of patterns) {
    const found = plain.match(pattern);
    if (!found) continue;
    let place = 0;
    return said.replace(/\{(\d*)\}/g, (all, which) => numbers(phrase(found[which === "" ? (place += 1) : Number(which) + 1])));
  }
  return text ?? "";
}

// The story of a scene: where it is not translated as a whole, its first sentence alone.
export function story(text) {
  const first = /^.*?[.?](?=\s|$)/.exec(text ?? "")?.[0] ?? "";
  const said = phrase(first);
  return said !== first && phrase(text) === text ? said : phrase(text);
}

// Write the words into the elements that ask for them: data-word for the text, data-word-title, data-word-label.
export function spell(root = document) {
  document.documentElement.lang = language;
  for (const element of root.querySelectorAll("[data-word], [data-word-title], [data-word-label]")) {
    const { word: text, wordTitle: title, wordLabel: label } = element.dataset;
    if (text) element.textContent = word(text);
    if (title) element.title = word(title);
    if (label) element.setAttribute("aria-label", word(label));
  }
}
