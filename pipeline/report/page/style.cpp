#include "pipeline/report/page/style.hpp"

namespace aeroloom::page {

std::string_view style_sheet() {
  return R"css(
:root {
  color-scheme: light dark;
  --paper: #ffffff; --panel: #f4f6f8; --ink: #17202a; --quiet: #5b6773; --line: #d5dbe1; --link: #0b5cad;
  --bar: #3b76b5; --second: #b3261e; --beyond: #b3261e; --good: #1b6e3c; --fair: #8a5a00; --poor: #b3261e;
}
@media screen and (prefers-color-scheme: dark) {
  :root {
    --paper: #14181d; --panel: #1e242b; --ink: #e6eaee; --quiet: #9aa6b2; --line: #37414b; --link: #7db8f5;
    --bar: #6fa8dc; --second: #ff8a80; --beyond: #ff8a80; --good: #6fd396; --fair: #f0bb55; --poor: #ff8a80;
  }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; }
main, footer { max-width: 1180px; margin: 0 auto; padding: 0 20px; }
footer { color: var(--quiet); padding-bottom: 24px; font-size: 13px; }
h1 { font-size: 26px; line-height: 1.25; margin: 24px 0 4px; overflow-wrap: anywhere; }
h2 { font-size: 20px; margin: 0 0 10px; padding-top: 18px; border-top: 1px solid var(--line); }
h3 { font-size: 15px; margin: 18px 0 6px; }
p { margin: 6px 0; }
a { color: var(--link); }
code, pre { font-family: ui-monospace, "DejaVu Sans Mono", monospace; font-size: 0.88em; overflow-wrap: anywhere; }
pre { white-space: pre-wrap; background: var(--panel); padding: 10px 12px; border-radius: 6px; margin: 8px 0; }
section { margin: 22px 0; }
nav { margin: 14px 0 0; font-size: 14px; }
nav a { margin-right: 12px; }
.quiet, .more, .hash { color: var(--quiet); }
.more { font-style: italic; }
.tiles { display: grid; grid-template-columns: repeat(auto-fill, minmax(165px, 1fr)); gap: 10px; margin: 14px 0 8px; }
.tile { background: var(--panel); border: 1px solid var(--line); border-radius: 6px; padding: 8px 12px; }
.tile span { display: block; color: var(--quiet); font-size: 13px; }
.tile b { font-size: 18px; overflow-wrap: anywhere; font-variant-numeric: tabular-nums; }
.badge { display: inline-block; padding: 0 8px; border: 1px solid currentColor; border-radius: 10px; font-size: 13px;
  font-weight: 600; white-space: nowrap; vertical-align: 2px; }
h1 .badge { font-size: 15px; }
.badge.good { color: var(--good); } .badge.fair { color: var(--fair); } .badge.poor { color: var(--poor); }
.badge.plain { color: var(--quiet); }
.verdict { list-style: none; padding: 0; }
.verdict li { margin: 6px 0; }
.warnings li { margin: 6px 0; white-space: pre-line; overflow-wrap: anywhere; }
.failure { border: 2px solid var(--poor); border-radius: 8px; padding: 2px 16px 10px; }
.failure h2 { border-top: 0; color: var(--poor); }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: 14px; min-width: 40%; }
th, td { text-align: left; padding: 3px 14px 3px 0; border-bottom: 1px solid var(--line); vertical-align: top; }
th { color: var(--quiet); font-weight: 600; border-bottom-width: 2px; }
td { overflow-wrap: anywhere; min-width: 3em; }
.place { white-space: nowrap; }
.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
dl { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 340px), 1fr)); gap: 4px 20px; margin: 8px 0; }
dl div { display: flex; gap: 8px; }
dt { color: var(--quiet); flex: none; } dt::after { content: ":"; }
dd { margin: 0; overflow-wrap: anywhere; }
.charts { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 440px), 1fr)); gap: 10px 20px; margin: 10px 0; }
svg { forced-color-adjust: none; }
svg text { fill: var(--ink); font-size: 11px; }
svg text { paint-order: stroke; stroke: var(--paper); stroke-width: 3px; stroke-linejoin: round; }
svg .title { font-size: 13px; font-weight: 600; }
svg .grid { stroke: var(--line); stroke-width: 1; }
svg .axis { stroke: var(--ink); stroke-width: 1; }
svg .mark { stroke: var(--ink); stroke-width: 1.2; stroke-dasharray: 4 3; }
svg .count, svg .filled { fill: var(--bar); }
svg .beyond { fill: var(--beyond); stroke: var(--ink); stroke-width: 0.8; }
svg .trough { fill: var(--line); }
.chart, .loads { width: 100%; height: auto; }
.loads { min-width: 520px; }
.bar { width: 90px; height: 10px; vertical-align: middle; }
.small { width: 150px; height: 20px; vertical-align: middle; }
.stage0 { fill: #555f69; } .stage1 { fill: #9fc6e8; } .stage2 { fill: #7a4f9a; } .stage3 { fill: #e3b04b; }
.stage4 { fill: #2f7f86; } .stage5 { fill: #3b6fb5; } .stage6 { fill: #f0997a; } .stage7 { fill: #8a2f4a; }
.stage8 { fill: #a9c77b; } .stage9 { fill: #2b3a67; }
svg .ideal { fill: none; stroke: var(--quiet); stroke-width: 1.2; stroke-dasharray: 2 3; }
svg .stroke0, svg .stroke1, svg .stroke2, svg .stroke3 { fill: none; stroke: var(--bar); stroke-width: 1.8; }
svg .stroke1 { stroke: var(--second); stroke-dasharray: 7 3; } svg .stroke2 { stroke: var(--good); stroke-dasharray: 2 2; }
svg .stroke3 { stroke: var(--fair); stroke-dasharray: 7 3 2 3; }
svg .hollow { fill: var(--paper); stroke-dasharray: none; }
svg .line0 { fill: var(--bar); } svg .line1 { fill: var(--second); }
svg .line2 { fill: var(--good); } svg .line3 { fill: var(--fair); }
.bars rect { stroke: var(--paper); stroke-width: 1; }
.loads rect, .legend rect:not(.hollow), .swatch rect { stroke: var(--paper); stroke-width: 1; }
.swatch, .legend svg { width: 12px; height: 12px; margin-right: 6px; vertical-align: -1px; }
.legend { list-style: none; display: flex; flex-wrap: wrap; gap: 2px 14px; padding: 0; margin: 6px 0; font-size: 13px; }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 420px), 1fr)); gap: 18px; }
figure { margin: 0; } figure.broad { grid-column: 1 / -1; }
figure img { width: 100%; height: auto; border: 1px solid var(--line); background: #ffffff; border-radius: 4px; }
figcaption { font-size: 14px; }
summary { cursor: pointer; }
@media (max-width: 560px) {
  body { font-size: 14px; }
  main, footer { padding: 0 12px; }
  .tiles { grid-template-columns: repeat(2, 1fr); }
  .tile b { font-size: 17px; }
  h1 { font-size: 21px; }
  td:not(.number) { min-width: 8em; }
}
@media print {
  @page { size: A4; margin: 14mm; }
  :root { --bar: #4a4a4a; --second: #000000; --beyond: #ffffff; }
  body { font-size: 10pt; }
  main, footer { max-width: none; padding: 0; }
  nav { display: none; }
  .wide { overflow: visible; }
  .loads { min-width: 0; }
  dl { grid-template-columns: 1fr 1fr; }
  table { max-width: 100%; font-size: 8pt; }
  th, td { padding-right: 6px; min-width: 0; }
  .place, .number { white-space: normal; overflow-wrap: normal; }
  thead { display: table-header-group; }
  tr, figure, .tile, .chart, .part > h3, li { break-inside: avoid; }
  h2, h3 { break-after: avoid; }
  .tiles { grid-template-columns: repeat(4, 1fr); }
  .tile b { font-size: 13pt; }
  .charts, .figures { grid-template-columns: 1fr 1fr; }
  .bar { width: 45px; }
  .badge, .tile, svg, figure img { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  details::details-content { content-visibility: visible; display: block; height: auto; }
  .configuration { columns: 2; font-size: 7pt; }
}
)css";
}

}  // namespace aeroloom::page
