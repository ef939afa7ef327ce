// The texts of the page in the reader's language: one table for each language, in atmosbox/page/language.
//
// `word` gives a text of the page itself by its key; `phrase` translates an English text of a scene or of the program.

const TABLES = JSON.parse(document.getElementById("words")?.textContent ?? "{}");
const NUMBER = /(\d)\.(\d)/g; // the decimal point of a number

const known = (wanted) => [wanted, wanted?.slice(0, 2)].find((each) => TABLES[each]);

// The language that was asked for, or the first of the browser's languages that the page has.
const first = () => {
  const asked = document.documentElement.dataset.language;
  const wanted = asked && asked !== "auto" ? [asked] : navigator.languages ?? [];
  return wanted.map(known).find(Boolean) ?? "en";
};

// The languages of this page with their own names.
export const languages = Object.entries(TABLES).map(([key, { name }]) => [key, name]);

const english = TABLES.en ?? {};
export let language;
let table, patterns;

// Take a language; `spell` then writes its texts into the page.
export function speak(wanted) {
  language = wanted;
  table = TABLES[language] ?? {};
  // English sentences with gaps as regular expressions, the longest first
  patterns = Object.entries(table.phrase ?? {}).filter(([text]) => text.includes("{}"))
    .toSorted(([one], [other]) => other.length - one.length)
    .map(([text, said]) => [new RegExp(`^${text.split("{}").map((part) => part.replace(/[.*+?^${}()|[\]\\]/g, "\\$&")).join("(.+?)")}$`), said]);
}

speak(first());

const filled = (text, values) => text.replace(/\{(\w+)\}/g, (all, name) => values[name] ?? all);

// The text of a key, with values in place of the names in braces.
export const word = (key, values = {}) => filled(table.page?.[key] ?? english.page?.[key] ?? key, values);

// A text whose numbers are written as in the language.
export const numbers = (text) => (table.decimal && table.decimal !== "." ? text.replace(NUMBER, `$1${table.decimal}$2`) : text);

// A text of a scene or of the program, translated if the table has it, with the numbers that it contains.
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

// The explanation of a term in one line; undefined for a word that everybody knows.
export const gloss = (text) => table.gloss?.[text] ?? english.gloss?.[text];

// A text, sentence by sentence; if not all of them are translated, only its first sentence.
export function story(text) {
  const parts = (text ?? "").split(/(?<=[.?]) /), said = parts.map(phrase);
  if (said.every((each, place) => each !== parts[place])) return said.join(" ");
  return said[0] === parts[0] ? text ?? "" : said[0];
}

// Write the texts into the elements that ask for them: data-word for the content, data-word-title, data-word-label.
export function spell(root = document) {
  document.documentElement.lang = language;
  for (const element of root.querySelectorAll("[data-word], [data-word-title], [data-word-label]")) {
    const { word: text, wordTitle: title, wordLabel: label } = element.dataset;
    if (text) element.textContent = word(text);
    if (title) element.title = word(title);
    if (label) element.setAttribute("aria-label", word(label));
  }
}
