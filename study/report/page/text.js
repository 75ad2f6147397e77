// Numbers and tables as text.

const unknownText = "–";

/** A number with the digits that say something: 0.012346, 1.23e-7. */
function numberText(value, digits = 4) {
  if (!isKnown(value)) return unknownText;
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (Number.isInteger(value) && size < 1e6) return String(value).replace("-", "−");
  if (size >= 10 ** digits - 0.5 && size < 1e6) return value.toFixed(0).replace("-", "−");
  const text = size < 1e-3 || size >= 1e6 ? value.toExponential(digits - 1) : value.toPrecision(digits);
  const [mantissa, exponent] = text.split("e");
  const short = mantissa.includes(".") ? mantissa.replace(/\.?0+$/, "") : mantissa;
  return (exponent === undefined ? short : `${short}e${exponent.replace("+", "")}`).replaceAll("-", "−");
}

/** For a table: a number without the digits that nobody asked for. */
const roundedTo = (digits, value) => (isKnown(value) ? Number(value.toPrecision(digits)) : null);

const wholeText = (count) => String(count).replace(/\B(?=(\d{3})+$)/g, "\u202f");
const counted = (count, noun, plural = `${noun}s`) => `${wholeText(count)} ${count === 1 ? noun : plural}`;
const percentText = (share, digits = 3) => `${numberText(100 * share, digits)} %`;
const signedText = (value, digits) => (value > 0 ? "+" : "") + numberText(value, digits);

/** An error in words: where it is relative and large enough to be thought of in percent, in both. */
function errorText(error) {
  if (!isKnown(error)) return unknownText;
  return error >= 1e-4 ? `${numberText(error, 3)} (${percentText(error)})` : numberText(error, 3);
}

/** 10⁻³, as an axis writes it. */
const powerText = (exponent) => `10${raised(exponent)}`;
const raised = (number) =>
  String(number)
    .replace("-", "⁻")
    .replace(/\d/g, (digit) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[digit]);

/** What cuts a long text without losing its end, where names differ most. */
function shortened(text, length) {
  if (text.length <= length) return text;
  const start = Math.ceil((length - 1) * 0.4);
  return `${text.slice(0, start)}…${text.slice(text.length - (length - 1 - start))}`;
}

const cellText = (cell) => (typeof cell === "number" ? numberText(cell, 6) : (cell ?? unknownText));

/** RFC 4180; numbers with all digits, nothing where one is not known. */
function csvText(columns, rows) {
  const field = (cell) => {
    const text = cell === null || cell === undefined ? "" : String(cell);
    return /[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  return [columns, ...rows].map((row) => row.map(field).join(",") + "\r\n").join("");
}
