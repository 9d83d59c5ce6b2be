// node build.mjs FOLDER: the page as one script, one style sheet and one document.
import {build} from 'esbuild';
import {copyFileSync} from 'node:fs';

const folder = process.argv[2];
if (!folder) throw new Error('expected the folder to build into');
const common = {bundle: true, minify: true, target: 'es2021', legalComments: 'none', logLevel: 'warning'};
await build({...common, entryPoints: ['src/main.tsx'], outfile: `${folder}/console.js`, format: 'esm',
             jsx: 'automatic', jsxImportSource: 'preact'});
await build({...common, entryPoints: ['src/simulator.tsx'], outfile: `${folder}/simulator.js`, format: 'esm',
             jsx: 'automatic', jsxImportSource: 'preact'});
await build({...common, entryPoints: ['src/console.css'], outfile: `${folder}/console.css`});
for (const page of ['index.html', 'simulator.html']) copyFileSync(`src/${page}`, `${folder}/${page}`);
