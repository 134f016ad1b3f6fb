// Runs a program that was built for wasm32-wasip1 by the WASI of node, with one folder to read, at
// its own path: node benches/wasi.mjs PROGRAM FOLDER [ARGUMENT]...
import { readFile } from 'node:fs/promises';
import { WASI } from 'node:wasi';

const [program, folder, ...words] = process.argv.slice(2);
const wasi = new WASI({
    version: 'preview1',
    args: [program, ...words],
    preopens: { [folder]: folder },
});
const module = await WebAssembly.compile(await readFile(program));
process.exitCode = wasi.start(await WebAssembly.instantiate(module, wasi.getImportObject()));
