// What benches/validator.sh runs, in one process: makes mutants by a seed, asks the validator of
// Khronos and rtc about each file, and prints how often both find the same set of error codes, and
// what differs by code, as Markdown.
//
// `node validator.mjs WORK RTC SHARED COUNT SEED`: WORK has the validator in node_modules and takes
// the files, SHARED holds `assets` and `validator-corpus`. LIST=1 names each file that differs on
// stderr.
import { execFileSync } from 'node:child_process';
import {
    chmodSync,
    cpSync,
    readFileSync,
    readdirSync,
    rmSync,
    statSync,
    writeFileSync,
} from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';

const [work, rtc, shared, count, seed] = process.argv.slice(2);
const validator = createRequire(resolve(work, 'x.js'))('gltf-validator');
const files = (folder) =>
    readdirSync(folder, { recursive: true })
        .map((name) => join(folder, name))
        .sort();

// Numbers from 0 to 1, the same for the same seed (mulberry32).
let state = Number(seed);
function random() {
    state = (state + 0x6d2b79f5) | 0;
    let t = Math.imul(state ^ (state >>> 15), state | 1);
    t = (t + Math.imul(t ^ (t >>> 7), t | 61)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
}
const below = (n) => Math.floor(random() * n);
const one = (list) => list[below(list.length)];

// A file as its JSON and, of a .glb, its other chunks.
function open(bytes) {
    if (bytes.toString('latin1', 0, 4) !== 'glTF') return { json: JSON.parse(bytes.toString()) };
    const end = 20 + bytes.readUInt32LE(12);
    return { json: JSON.parse(bytes.toString('utf8', 20, end)), rest: bytes.subarray(end) };
}
function close({ json, rest }) {
    const text = Buffer.from(JSON.stringify(json));
    if (!rest) return text;
    const padded = Buffer.concat([text, Buffer.alloc(-text.length & 3, ' ')]);
    const header = Buffer.from('glTF....____....JSON');
    [2, 20 + padded.length + rest.length, padded.length].forEach((word, at) =>
        header.writeUInt32LE(word, 4 + 4 * at),
    );
    return Buffer.concat([header, padded, rest]);
}

// The kind of place that a path leads to: list indices don't count. `genes` has what stands in each
// kind of object.
const kind = (path) => path.map((key) => (typeof key === 'number' ? '*' : key)).join('/');
const isHolder = (value) => value !== null && typeof value === 'object';
const genes = new Map();
function gather(value, path) {
    if (!isHolder(value)) return;
    for (const [key, inner] of Object.entries(value)) {
        if (!Array.isArray(value))
            genes.set(kind(path), [...(genes.get(kind(path)) ?? []), [key, inner]].slice(-400));
        gather(inner, [...path, Array.isArray(value) ? Number(key) : key]);
    }
}

// A random place: the holder, the key in it and the path; every level of nesting is as likely.
function place(json) {
    let [holder, path] = [json, []];
    for (;;) {
        const keys = Object.keys(holder);
        if (keys.length === 0) return null;
        const key = Array.isArray(holder) ? Number(one(keys)) : one(keys);
        const value = holder[key];
        if (!isHolder(value) || Object.keys(value).length === 0 || random() < 0.2)
            return { holder, key, path, value };
        [holder, path] = [value, [...path, key]];
    }
}

const ODD = [null, true, false, '', 'x', 0, 1, -1, 0.5, 3, 1e9, [], {}, [0], ['x'], { a: 1 }];
const WORDS = [
    'SCALAR',
    'VEC2',
    'VEC3',
    'VEC4',
    'MAT4',
    'MASK',
    'BLEND',
    'image/png',
    'image/jpeg',
    'image/webp',
    'image/jpg',
    'STEP',
    'CUBICSPLINE',
    'translation',
    'rotation',
    'scale',
    'weights',
    'pointer',
    'perspective',
    'orthographic',
    'spot',
    'point',
    'directional',
    '1.0',
    '2.1',
    'KHR_materials_unlit',
    'KHR_texture_transform',
    'KHR_mesh_quantization',
    '../x',
];
const copy = (value) => (value === undefined ? null : JSON.parse(JSON.stringify(value)));
function put(holder, key, value) {
    if (key !== '__proto__') holder[key] = copy(value);
}
function nudge(value) {
    if (typeof value === 'number')
        return one([value + 1, value - 1, -value, value * 2, value + 0.5, 0, 1e10]);
    if (typeof value === 'string') return one([...WORDS, `${value}x`, value.slice(1)]);
    if (typeof value === 'boolean') return !value;
    return Array.isArray(value) ? [] : {};
}
const CHANGES = {
    drop: ({ holder, key }) => (Array.isArray(holder) ? holder.splice(key, 1) : delete holder[key]),
    retype: ({ holder, key }) => put(holder, key, one(ODD)),
    nudge: ({ holder, key, value }) => put(holder, key, nudge(value)),
    move: ({ holder, key }, json) => put(holder, key, place(json)?.value),
    rename({ holder, key, value }, json) {
        if (Array.isArray(holder)) return holder.push(copy(value));
        delete holder[key];
        put(holder, random() < 0.3 ? `${key}s` : String(place(json)?.key ?? 'x'), value);
    },
    double({ holder, key, value }) {
        if (Array.isArray(holder)) holder.splice(below(holder.length + 1), 0, copy(value));
        else if (Array.isArray(value) && value.length > 0) value.push(copy(one(value)));
    },
    swap({ holder, key, value }) {
        const other = one(Object.keys(holder));
        [holder[key], holder[other]] = [holder[other], value];
    },
    // What stands in an object of the same kind, in this asset or in another one.
    cross({ holder, path, value, key }) {
        const [into, way] =
            isHolder(value) && !Array.isArray(value) ? [value, [...path, key]] : [holder, path];
        const pool = genes.get(kind(way));
        if (pool && !Array.isArray(into)) put(into, ...one(pool));
    },
};

// The bytes of a .glb with its header or chunks changed.
function breakGlb(bytes) {
    const word = (at, change) => {
        if (at + 4 <= bytes.length) bytes.writeUInt32LE(change(bytes.readUInt32LE(at)) >>> 0, at);
        return bytes;
    };
    const end = bytes.length < 20 ? 12 : 20 + bytes.readUInt32LE(12);
    const rest = bytes.subarray(end);
    const grown = (...parts) => Buffer.concat([bytes, ...parts]);
    const sized = (whole) => (whole.writeUInt32LE(whole.length, 8), whole);
    return one([
        () => bytes.subarray(0, below(48)),
        () => bytes.subarray(0, bytes.length - 1 - below(8)),
        () => word(one([4, 8, 12]), (old) => old + one([-4, -1, 1, 4, 8])),
        () => word(8, () => below(24)),
        () => word(one([16, end + 4]), () => one([0x4e4f534a, 0x004e4942, 0x12345678])),
        () => word(end, (old) => old + one([-4, -1, 1, 4])),
        () => grown(Buffer.alloc(1 + below(12))),
        () => sized(grown(rest)),
        () => sized(grown(bytes.subarray(12, end))),
        () => sized(Buffer.from(bytes.subarray(0, end))),
        () => sized(Buffer.concat([bytes.subarray(0, 12), rest])),
        () => sized(grown(Buffer.from([0, 0, 0, 0, 0x42, 0x49, 0x4e, 0]))),
    ])();
}

function mutant(bytes) {
    const asset = open(bytes);
    if (asset.rest && random() < 0.1) return breakGlb(Buffer.from(bytes));
    for (let changes = random() < 0.25 ? 2 : 1; changes > 0; changes -= 1) {
        const found = place(asset.json);
        if (found) one(Object.values(CHANGES))(found, asset.json);
    }
    return close(asset);
}

// Some bytes of accessors and images changed: in the binary chunk of a .glb, else in a data URI;
// null if there is none.
const WORDS_OF_BYTES = [
    0, 0x7fc00000, 0x7f800000, 0xff800000, 0x3f800000, 0xbf800000, 0x7f7fffff, 0xffffffff, 1,
];
function breakBytes(data) {
    for (let changes = 1 + below(4); changes > 0 && data.length > 4; changes -= 1) {
        const at = below(data.length - 4);
        if (random() < 0.4) data.writeUInt32LE(one(WORDS_OF_BYTES), at & ~3);
        else data[at] = one([data[at] ^ (1 << below(8)), 0, 255, below(256)]);
    }
    return data;
}
function mutantOfBytes(bytes) {
    const { json, rest } = open(bytes);
    if (rest && rest.length > 12) {
        const own = Buffer.from(bytes);
        breakBytes(own.subarray(own.length - rest.length + 8));
        return own;
    }
    const holders = [...(json.buffers ?? []), ...(json.images ?? [])];
    const written = holders.filter(({ uri }) => /^data:[^,]*;base64,/.test(uri ?? ''));
    if (rest || written.length === 0) return null;
    const holder = one(written);
    const [head, data] = holder.uri.split(',');
    holder.uri = `${head},${breakBytes(Buffer.from(data, 'base64')).toString('base64')}`;
    return close({ json });
}

// An error that the validator throws outside of its promise: the file is left out.
let thrown = false;
process.on('uncaughtException', (fault) => {
    if (!String(fault?.stack ?? fault).includes('gltf_validator')) throw fault;
    thrown = true;
});

// What the validator finds in a file: the names of errors (0) and warnings (1). What lies in
// extensions that it says it does not know is left out, here and of what rtc finds.
async function official(file) {
    const load = (uri) =>
        new Promise((done) =>
            done(new Uint8Array(readFileSync(join(dirname(file), decodeURIComponent(uri))))),
        );
    const options = { uri: file, maxIssues: 0, externalResourceFunction: load };
    const [found, unknown] = [new Map(), []];
    thrown = false;
    try {
        const report = await validator.validateBytes(new Uint8Array(readFileSync(file)), options);
        const { messages } = report.issues;
        const names = messages
            .filter(({ code }) => code === 'UNSUPPORTED_EXTENSION')
            .map(({ message }) => /'(.*)'/.exec(message));
        unknown.push(...names.map((name) => `/extensions/${name?.[1]}`));
        for (const { code, severity, pointer } of messages) {
            if (severity > 1 || unknown.some((way) => pointer?.includes(way))) continue;
            found.set(code, Math.min(severity, found.get(code) ?? 2));
        }
    } catch (fault) {
        // The validator itself fails, so there is nothing to compare with.
        return { khronos: null };
    }
    return thrown ? { khronos: null } : { khronos: found, unknown };
}

// What rtc finds in many files: by file, the names of errors (0) and warnings (1).
function ours(list) {
    const found = new Map(list.map((file) => [file, new Map()]));
    for (let from = 0; from < list.length; from += 200) {
        const command = ['check', '--message-format', 'json', ...list.slice(from, from + 200)];
        let text;
        try {
            text = execFileSync(rtc, command, {
                maxBuffer: 2 ** 30,
                stdio: ['ignore', 'pipe', 'ignore'],
            });
        } catch (failed) {
            if (failed.status !== 1) throw failed;
            text = failed.stdout;
        }
        for (const line of text.toString().split('\n').filter(Boolean)) {
            const finding = JSON.parse(line);
            const severity = ['error', 'warning'].indexOf(finding.severity);
            const codes = found.get(finding.file);
            const isUnknown = (verdicts.get(finding.file)?.unknown ?? []).some((way) =>
                finding.pointer?.includes(way),
            );
            if (!codes || severity < 0 || isUnknown) continue;
            const name = finding.alias ?? finding.code;
            codes.set(name, Math.min(severity, codes.get(name) ?? 2));
        }
    }
    return found;
}

const of = (codes, severity) =>
    new Set([...codes].filter(([, own]) => own === severity).map(([code]) => code));

// Compares both for one severity; tells of the files in `groups`, and of codes that differ.
function table(groups, verdicts, severity) {
    const codes = new Map();
    const tell = (code, at) =>
        codes.set(
            code,
            (codes.get(code) ?? [0, 0]).map((old, own) => old + (own === at ? 1 : 0)),
        );
    console.log('| files | how many | same set | share |\n| --- | ---: | ---: | ---: |');
    for (const [name, list] of groups) {
        let [same, all] = [0, 0];
        for (const file of list) {
            const { khronos, own } = verdicts.get(file);
            if (khronos === null) continue;
            const [theirs, mine] = [of(khronos, severity), of(own, severity)];
            const missing = [...theirs].filter((code) => !mine.has(code));
            const beside = [...mine].filter((code) => !theirs.has(code));
            missing.forEach((code) => tell(code, 0));
            beside.forEach((code) => tell(code, 1));
            all += 1;
            same += missing.length + beside.length === 0 ? 1 : 0;
            if (process.env.LIST && missing.length + beside.length > 0) {
                console.error(
                    `${severity ? 'warning' : 'error'} ${file}: missing [${missing}], beside [${beside}]`,
                );
            }
        }
        console.log(
            `| ${name} | ${all} | ${same} | ${((100 * same) / Math.max(all, 1)).toFixed(1)} % |`,
        );
    }
    console.log('\n| code | only the validator | only rtc |\n| --- | ---: | ---: |');
    const order = [...codes].sort(([a, [b, c]], [d, [e, f]]) => e + f - b - c || (a < d ? -1 : 1));
    order.forEach(([code, [missing, beside]]) =>
        console.log(`| ${code} | ${missing} | ${beside} |`),
    );
}

// Copies of both folders that can be written into, mutants beside what they were made of.
const names = ['assets', 'validator-corpus'];
const originals = names.map((name) => {
    const folder = join(work, name);
    rmSync(folder, { recursive: true, force: true });
    cpSync(join(shared, name), folder, { recursive: true });
    files(folder).forEach((path) => chmodSync(path, statSync(path).isDirectory() ? 0o755 : 0o644));
    return files(folder).filter((path) => /\.gl(tf|b)$/.test(path));
});
const verdicts = new Map();
for (const file of originals.flat()) verdicts.set(file, await official(file));
const isJson = (file) => {
    try {
        return isHolder(open(readFileSync(file)).json);
    } catch (fault) {
        return false;
    }
};
const isSound = (file) => of(verdicts.get(file).khronos ?? new Map(), 0).size === 0;
const sources = [originals[0].filter(isSound), originals[1]].map((list) => list.filter(isJson));
sources.flat().forEach((file) => gather(open(readFileSync(file)).json, []));
const mutants = [[], []];
for (let index = 0; index < Number(count); index += 1) {
    const source = one(sources[index % 2]);
    const file = source.replace(/(\.\w+)$/, `.${index}$1`);
    writeFileSync(file, mutant(readFileSync(source)));
    mutants[index % 2].push(file);
    verdicts.set(file, await official(file));
}
const bytesOf = [];
const whole = sources
    .flat()
    .filter((file) => isSound(file) && mutantOfBytes(readFileSync(file)) !== null);
for (let index = 0; whole.length > 0 && index < Number(count) / 2; index += 1) {
    const source = one(whole);
    const file = source.replace(/(\.\w+)$/, `.bytes-${index}$1`);
    writeFileSync(file, mutantOfBytes(readFileSync(source)));
    bytesOf.push(file);
    verdicts.set(file, await official(file));
}
ours([...verdicts.keys()]).forEach((own, file) => (verdicts.get(file).own = own));

const groups = [
    ...names.map((name, at) => [`\`${name}\``, originals[at]]),
    ...names.map((name, at) => [`mutants of \`${name}\``, mutants[at]]),
    ['bytes of accessors and images', bytesOf],
];
console.log(`# Findings in glTF beside the validator of Khronos

\`benches/validator.sh\` writes this page. It compares the sets of codes that \`rtc\` and
gltf-validator ${validator.version()} of Khronos find in a file, here with ${count} mutants and seed
${seed}. Two things are left out: findings in extensions that the validator does not know, and files
on which the validator itself fails.

${process.env.STATE}

## Errors
`);
table(groups, verdicts, 0);
console.log('\n## Warnings\n\nThe project makes no promise about warnings.\n');
table(groups, verdicts, 1);
