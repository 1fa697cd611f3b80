// What a reader saves from a page.

/**
 * @param {string} name of the file
 * @param {Blob} content
 */
function saveFile(name, content) {
  const link = document.createElement("a");
  link.download = name;
  link.href = URL.createObjectURL(content);
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000); // a busy browser reads it late
}

/**
 * @param {string} name of the file
 * @param {string} text
 */
function saveCsv(name, text) {
  saveFile(name, new Blob([text], { type: "text/csv" }));
}
