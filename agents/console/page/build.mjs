// node build.mjs FOLDER: each page as one document, with its script and its style sheet inside: one request on a slow link.
import {build} from 'esbuild';
import {copyFileSync, readFileSync, writeFileSync} from 'node:fs';

const folder = process.argv[2];
if (!folder) throw new Error('expected the folder to build into');
const bundled = async (entry, more) => {
  const made = await build({bundle: true, minify: true, target: 'es2021', legalComments: 'none', logLevel: 'warning', write: false,
                            entryPoints: [`src/${entry}`], ...more});
  return made.outputFiles[0].text.trim();
};
for (const file of ['manifest.json', 'icon.svg']) copyFileSync(`src/${file}`, `${folder}/${file}`);   // to install it as an app
const style = await bundled('console.css', {});
for (const [page, entry] of [['index.html', 'main.tsx'], ['simulator.html', 'simulator.tsx']]) {
  const script = await bundled(entry, {format: 'esm', jsx: 'automatic', jsxImportSource: 'preact'});
  const text = readFileSync(`src/${page}`, 'utf8');
  writeFileSync(`${folder}/${page}`, text.replace('<style></style>', () => `<style>${style}</style>`)
    .replace('<script type="module"></script>', () => `<script type="module">${script}</script>`));
}
