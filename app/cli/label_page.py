"""How the report of `metagraph label` looks, and its script: it filters, sorts and copies, and fetches
nothing.
"""

from __future__ import annotations

STYLE = """
:root { color-scheme: dark light; --ground: #17181b; --card: #25282d; --line: #34383f; --text: #dfe3e8; --dim: #9aa1ab; --warn: #e8c24a;
  --stance: #3fb8a6; --gesture: #f0a63c; --fidget: #a98bf0; --transition: #5aa3f0; }
@media (prefers-color-scheme: light) {
  :root { --ground: #f6f7f8; --card: #fff; --line: #cdd2d8; --text: #1d2126; --dim: #59616b; --warn: #7d5b00;
    --stance: #127065; --gesture: #8f5a00; --fidget: #6a45c4; --transition: #1a63b8; }
}
body { margin: 0 auto; max-width: 1180px; padding: 24px; background: var(--ground); color: var(--text);
  font: 14px/1.45 system-ui, sans-serif; }
h1 { font-size: 22px; } h2 { font-size: 17px; margin-top: 36px; } h3 { font-size: 14px; color: var(--dim); margin: 22px 0 8px; }
.cards { display: grid; grid-template-columns: repeat(auto-fill, minmax(360px, 1fr)); gap: 10px; }
.card { display: grid; grid-template-columns: 96px 1fr; gap: 12px; padding: 10px;
  background: var(--card); border: 1px solid var(--line); border-radius: 8px; }
.card img, .card .none { width: 96px; height: 96px; border-radius: 6px; }
.card b { overflow-wrap: anywhere; } .dim { color: var(--dim); } .warn { color: var(--warn); }
.stance { color: var(--stance); } .gesture { color: var(--gesture); }
.fidget { color: var(--fidget); } .transition { color: var(--transition); }
.bar { position: sticky; top: 0; z-index: 1; display: flex; flex-wrap: wrap; gap: 10px; align-items: center; padding: 10px 0; background: var(--ground); }
.bar input, .bar select, button { font: inherit; color: inherit; background: var(--card); border: 1px solid var(--line); border-radius: 6px; padding: 5px 9px; }
button { cursor: pointer; } button:hover, button[aria-pressed=true] { border-color: var(--text); }
.stances { display: grid; grid-template-columns: repeat(auto-fill, minmax(190px, 1fr)); gap: 10px; }
.stances button { text-align: left; padding: 10px; border-radius: 8px; }
.stances img, .stances .none { display: block; width: 100%; aspect-ratio: 1; border-radius: 6px; margin-bottom: 8px; object-fit: cover; }
.stances button > span { display: block; font-size: 13px; } .stances b { overflow-wrap: anywhere; }
.open { font-size: 12px; padding: 2px 8px; margin-top: 6px; } code { display: block; font-size: 12px; margin-top: 6px; overflow-wrap: anywhere; user-select: all; }
[hidden] { display: none !important; }
ul { margin: 4px 0 0; padding-left: 18px; font-size: 13px; }
"""

SCRIPT = """
const cards = [...document.querySelectorAll('.card')], field = id => document.getElementById(id);
const first = new Map(cards.map((card, n) => [card, n]));
let stance = '';
function show() {
  const words = field('find').value.toLowerCase().split(/\\s+/).filter(Boolean), kind = field('kind').value, layer = field('layer').value;
  let count = 0;
  for (const card of cards) {
    const d = card.dataset, text = card.textContent.toLowerCase();
    const on = words.every(w => text.includes(w)) && (!kind || d.kind === kind) && (!layer || d.layer === layer)
      && (!stance || d.stance === stance || d.end === stance) && (!field('look').checked || d.look === '1');
    card.hidden = !on; count += on;
  }
  for (const part of document.querySelectorAll('section')) part.hidden = !part.querySelector('.card:not([hidden])');
  field('count').textContent = count + ' of ' + cards.length + ' clips';
  for (const b of document.querySelectorAll('.stances button')) b.setAttribute('aria-pressed', b.dataset.stance === stance);
}
function sort() {
  const by = field('sort').value, key = {name: c => c.dataset.name, sure: c => +c.dataset.sure, kind: c => c.dataset.kind}[by];
  for (const box of document.querySelectorAll('.cards')) {
    const mine = [...box.children];
    mine.sort((a, b) => { if (key) { const x = key(a), y = key(b); if (x < y) return -1; if (x > y) return 1; } return first.get(a) - first.get(b); });
    box.append(...mine);
  }
}
for (const id of ['find', 'kind', 'layer', 'look']) field(id).addEventListener('input', show);
field('sort').addEventListener('input', sort);
field('all').addEventListener('click', () => { for (const id of ['find', 'kind', 'layer']) field(id).value = ''; field('look').checked = false; stance = ''; show(); });
for (const b of document.querySelectorAll('.stances button'))
  b.addEventListener('click', () => { stance = stance === b.dataset.stance ? '' : b.dataset.stance; show(); });
for (const b of document.querySelectorAll('.open')) b.addEventListener('click', () => {
  const code = b.nextElementSibling; code.hidden = false;
  const range = document.createRange(); range.selectNodeContents(code);
  const chosen = getSelection(); chosen.removeAllRanges(); chosen.addRange(range);
  let done = false; try { done = document.execCommand('copy'); } catch (e) {}
  b.textContent = done ? 'Copied: paste it in a terminal' : 'Copy this into a terminal:';
});
show();
"""
