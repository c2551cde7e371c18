// Displays of equations: pymdownx.arithmatex leaves \[ ... \] in elements of the class arithmatex.
for (const element of document.querySelectorAll(".arithmatex")) {
  const text = element.textContent.trim().replace(/^\\\[|\\\]$/g, "");
  katex.render(text, element, {displayMode: true, throwOnError: false});
}
