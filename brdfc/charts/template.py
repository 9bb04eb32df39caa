"""The frame of the page: style, places to fill, and the script that adds the keyboard."""

from __future__ import annotations

PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>$title</title>
<style>
body { font: 15px/1.45 system-ui, sans-serif; color: #1a1a1a; max-width: 1250px; margin: 1.5em auto;
  padding: 0 1em; background: #fff }
figure { margin: 0 }
figure svg { width: 100%; height: auto }
.mark { cursor: pointer; outline: none }
.mark:hover use, .mark:focus use { stroke: #000; stroke-width: 3px }
#readout { white-space: pre-wrap; overflow-wrap: anywhere; font-family: ui-monospace, monospace;
  font-size: 13px; background: #f3f3f3; padding: .7em 1em; margin: 0 0 1.5em; min-height: 6.2em;
  max-height: 14em; overflow: auto }
.scroll { overflow-x: auto }
table { border-collapse: collapse; width: 100% }
th, td { text-align: right; padding: .3em .6em; border-bottom: 1px solid #ddd; vertical-align: top }
thead th { position: sticky; top: 0; background: #fff; vertical-align: bottom }
th:first-child, td:nth-child(8), td:last-child, thead th:last-child { text-align: left }
th[scope=row] { font-weight: normal; white-space: nowrap }
td { font-variant-numeric: tabular-nums }
td:last-child { min-width: 22em; overflow-wrap: anywhere }
tr.front { background: #e8f2f9 }
tr.chosen { background: #dff3ec; font-weight: bold }
code { font-size: 12.5px; font-weight: normal }
summary:focus-visible, .scroll:focus-visible { outline: 2px solid #0072B2 }
</style>
</head>
<body>
<main>
<h1 hidden>$title</h1>
<figure>
$picture
</figure>
<div id="readout" role="status">Point at a mark for its formula and figures.</div>
<h2>All candidates, cheapest first</h2>
<div class="scroll" tabindex="0" role="region" aria-label="All candidates">
<table>
<thead><tr>$headings</tr></thead>
<tbody>
$rows
</tbody>
</table>
$notes
</div>
</main>
<script>
"use strict";
const readout = document.getElementById("readout");
readout.textContent = "Point at a mark for its formula and figures, or reach one with Tab and go "
  + "on with the arrow keys: left is cheaper, right dearer, up and down change the panel.";
const panels = { bits: [], de: [] };
for (const mark of document.querySelectorAll(".mark")) panels[mark.dataset.panel].push(mark);
for (const marks of Object.values(panels))
  marks.sort((a, b) => a.dataset.price - b.dataset.price);
const show = event => {
  const mark = event.target.closest(".mark");
  if (mark) readout.textContent = mark.getAttribute("aria-label");
};
document.addEventListener("pointerover", show);
document.addEventListener("focusin", show);
document.addEventListener("keydown", event => {
  const mark = event.target.closest(".mark");
  if (!mark) return;
  const step = { ArrowLeft: -1, ArrowRight: 1, ArrowUp: 0, ArrowDown: 0 }[event.key];
  if (step === undefined) return;
  const marks = panels[mark.dataset.panel];
  const other = panels[mark.dataset.panel === "bits" ? "de" : "bits"];
  const next = step ? marks[marks.indexOf(mark) + step]
    : other.find(m => m.id.split("-")[1] === mark.id.split("-")[1]);
  if (next) next.focus();
  event.preventDefault();
});
</script>
</body>
</html>
"""
"""For string.Template: title, picture, headings and rows, all escaped already."""
