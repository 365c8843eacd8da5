/* Finds and sorts the parts of a batch. What was asked for stays when one comes back from a report. */

const { columns, rows: values } = JSON.parse(document.getElementById("data").textContent);
const body = document.getElementById("parts");
const words = document.getElementById("words");
const rows = [...body.rows].map((element, i) => ({ element, values: values[i], text: element.textContent.toLowerCase() }));
const choices = [...document.querySelectorAll("button[data-column]")];
const heads = [...document.querySelectorAll("th[data-sort]")];
const ALL = { column: "", value: "0", words: "", by: "", falling: false };
let asked = { ...ALL, ...history.state };

/** Show what is asked for. */
function show() {
  const column = columns.indexOf(asked.column);
  const parts = asked.words.toLowerCase().split(/\s+/);
  let count = 0;
  for (const row of rows) {
    const chosen = column < 0 || String(row.values[column]) === asked.value;
    row.element.hidden = !(chosen && parts.every((part) => row.text.includes(part)));
    count += row.element.hidden ? 0 : 1;
  }
  choices.forEach((button) => {
    const { column: of, value } = button.dataset;
    button.setAttribute("aria-pressed", String(of === asked.column && value === asked.value));
  });
  document.getElementById("count").textContent = count < rows.length ? `${count} of ${rows.length} parts` : "";
  document.getElementById("none").hidden = count > 0;
}

/** Put the rows in order; those of which nothing is known come last. */
function sort() {
  const column = columns.indexOf(asked.by);
  heads.forEach((head) => {
    if (head.className === asked.by) head.setAttribute("aria-sort", asked.falling ? "descending" : "ascending");
    else head.removeAttribute("aria-sort");
  });
  const sign = asked.falling ? -1 : 1;
  const compare = ({ values: a }, { values: b }) => {
    if (a[column] === null || b[column] === null) return (a[column] === null) - (b[column] === null);
    return sign * (a[column] - b[column]);
  };
  body.append(...(column < 0 ? rows : [...rows].sort(compare)).map(({ element }) => element));
}

function ask(change) {
  asked = { ...asked, ...change };
  history.replaceState(asked, "");
}

choices.forEach((button) => {
  button.addEventListener("click", () => {
    const { column, value } = button.dataset;
    const again = button.classList.contains("go") && button.getAttribute("aria-pressed") === "true";
    ask(again ? { column: "", value: "0" } : { column, value });
    show();
    if (button.classList.contains("go")) document.querySelector(".find").scrollIntoView();
  });
});

words.value = asked.words;
words.addEventListener("input", () => {
  ask({ words: words.value });
  show();
});

heads.forEach((head) => {
  const button = document.createElement("button");
  button.type = "button";
  button.append(...head.childNodes);
  button.addEventListener("click", () => {
    // Names and verdicts from the first, numbers from the largest.
    const first = !["part", "status"].includes(head.className);
    ask({ by: head.className, falling: asked.by === head.className ? !asked.falling : first });
    sort();
  });
  head.append(button);
});

document.documentElement.classList.add("live");
sort();
show();
