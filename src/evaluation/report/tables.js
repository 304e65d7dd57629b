// Tables that sort by a column; text by its letters, numbers by size, empty cells last.
function cellText(value) {
  if (value === null) return "–";
  if (typeof value !== "number" || Number.isInteger(value)) return String(value);
  return Math.abs(value) >= 1e6 || Math.abs(value) < 1e-4 ? value.toExponential(3) : String(+value.toPrecision(5));
}

function isTrained(columns, row) {
  const of = name => row[columns.indexOf(name)];
  return of("trained_on") === "yes" || of("training_clips") > 0;
}

function tableBody(table) {
  return table.rows.map(row => {
    const line = element("tr");
    row.forEach((value, column) => {
      const cell = element("td", typeof value === "string" ? {class: "text"} : {}, cellText(value));
      if (column === 0 && isTrained(table.columns, row))
        cell.append(element("span", {class: "mark", title: "The model was trained on it"}, "trained on"));
      line.append(cell);
    });
    return line;
  });
}

function sortTable(table, column, falling) {
  table.rows.sort((a, b) => {
    const [x, y] = [a[column], b[column]];
    if (x === null || y === null) return (x === null) - (y === null);
    const order = typeof x === "number" && typeof y === "number" ? x - y
      : String(x).localeCompare(String(y), undefined, {numeric: true});
    return falling ? -order : order;
  });
}

function tableView(table, open) {
  const head = element("tr"), body = element("tbody");
  table.columns.forEach((name, column) => {
    const isText = table.rows.some(row => typeof row[column] === "string");
    const cell = element("th", {scope: "col", "aria-sort": "none", class: isText ? "text" : ""},
                         element("button", {type: "button"}, name.replaceAll("_", " ")));
    cell.addEventListener("click", () => {
      const falling = cell.getAttribute("aria-sort") === "ascending";
      for (const other of head.children) other.setAttribute("aria-sort", "none");
      cell.setAttribute("aria-sort", falling ? "descending" : "ascending");
      sortTable(table, column, falling);
      body.replaceChildren(...tableBody(table));
    });
    head.append(cell);
  });
  const view = element("details", {class: "panel table", ...(open ? {open: ""} : {})},
                 element("summary", {}, table.title, element("span", {}, table.file)),
                 element("div", {class: "scroll", tabindex: "0"},
                         element("table", {}, element("thead", {}, head), body)));
  // Rows are made when the table is opened: thousands of them would slow the page down.
  const fill = () => { if (view.open && !body.hasChildNodes()) body.replaceChildren(...tableBody(table)); };
  view.addEventListener("toggle", fill);
  fill();
  return view;
}
