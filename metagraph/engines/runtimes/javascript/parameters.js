/**
 * Parameters: the named values that a game sets without knowing any clip, stance or graph. Each is a typed name for a request: to set it
 * asks for that, with one field filled in.
 */

const isNumber = (x) => typeof x === "number" && !Number.isNaN(x);
const isLength = (x) => isNumber(x) && Math.abs(x) <= 1e6;

const TYPES = ["number", "boolean", "enum", "list", "point", "trigger"];
const isObject = (x) => typeof x === "object" && x !== null && !Array.isArray(x);

/** Return an export's parameters, by name. @param {?object} data @throws {Error} for what is none */
export function readParameters(data) {
  for (const [name, parameter] of Object.entries(data ?? {})) {
    const { type, request, choices = [], beside = [], replaces = [], field = "", least = 0, most = 1 } = parameter ?? {};
    const lists = [choices, beside, replaces].every(Array.isArray) && choices.every((x) => isObject(x) && typeof x.name === "string");
    const fine = TYPES.includes(type) && isObject(request) && lists && typeof field === "string" && isNumber(least) && isNumber(most);
    if (!fine || (type === "boolean" && choices.length !== 2)) throw new Error(`parameters.${name} is no parameter`);
  }
  return data ?? {};
}

/** The values that a character's parameters were set to. */
export class Parameters {
  /** @param {Record<string, object>} exported the export's `parameters` */
  constructor(exported) {
    this.exported = exported;
    this.values = new Map();
    this.made = new Map(); // the ids of their latest requests
  }

  /** Return the value of a parameter; undefined where there is none of that name, null for a trigger. */
  get(name) {
    if (!Object.hasOwn(this.exported, name)) return undefined;
    return this.values.has(name) ? this.values.get(name) : this.exported[name].initial ?? null;
  }

  /**
   * Set a parameter; `ask` gets the request that this makes, and `refuse` why there is none. Returns the request's id; that of the
   * earlier one where nothing changes.
   */
  set(name, value, ask, refuse) {
    if (!Object.hasOwn(this.exported, name)) return refuse(`name: there is no parameter '${name}'`);
    const parameter = this.exported[name];
    const [found, wrong] = readValue(parameter, value);
    if (wrong) return refuse(`value: ${wrong}`);
    const { type, field, request, beside = [], replaces = [] } = parameter;
    if (type === "trigger") return ask({ ...request });
    if (this.values.has(name) && isSame(this.values.get(name), found)) return this.made.get(name);
    const fields = { [field]: fillIn(parameter, found) };
    for (const other of beside) {
      if (this.values.has(other) && Object.hasOwn(this.exported, other)) fields[this.exported[other].field] = fillIn(this.exported[other], this.values.get(other));
    }
    for (const other of replaces) this.values.delete(other); // they are bound to the same
    this.values.set(name, found);
    this.made.set(name, ask({ ...request, ...fields }));
    return this.made.get(name);
  }
}

/** Return what parameters are, as plain data, by name. */
export function describeParameters(exported) {
  return Object.fromEntries(Object.entries(exported).map(([name, { type, about = "", initial, least = 0, most = 1, choices = [] }]) => [
    name,
    {
      type, about,
      ...(type === "trigger" ? {} : { initial }),
      ...(type === "number" ? { least, most } : {}),
      ...(type === "enum" || type === "list" ? { choices: choices.map((choice) => choice.name) } : {}),
    },
  ]));
}

const isSame = (a, b) => (Array.isArray(a) ? a.length === b.length && a.every((x, n) => x === b[n]) : a === b);

/** Return what a value puts into the request's field. */
function fillIn({ type, choices }, value) {
  if (type === "boolean") return choices[value ? 1 : 0].value;
  if (type === "enum") return choices.find((choice) => choice.name === value).value;
  if (type === "list") return choices.filter((choice) => value.includes(choice.name)).map((choice) => choice.value);
  return value;
}

/** Return a value as it is kept, and what is wrong with it, "" for nothing. */
function readValue({ type, choices = [], least = 0, most = 1 }, value) {
  const names = choices.map((choice) => choice.name);
  switch (type) {
    case "trigger":
      return [null, value === undefined || value === null ? "" : "a trigger has none"];
    case "number":
      return isNumber(value) ? [Math.min(Math.max(value, least), most), ""] : [null, "should be a number"];
    case "boolean":
      return [value, typeof value === "boolean" ? "" : "should be true or false"];
    case "enum":
      return [value, names.includes(value) ? "" : `should be one of ${names.join(", ")}`];
    case "list":
      if (!Array.isArray(value) || !value.every((x) => names.includes(x))) return [null, `should be a list of ${names.join(", ")}`];
      return [names.filter((name) => value.includes(name)), ""];
    default:
      if (!Array.isArray(value) || value.length !== 3 || !value.every(isLength)) return [null, "should be three numbers, metres"];
      return [[...value], ""];
  }
}
