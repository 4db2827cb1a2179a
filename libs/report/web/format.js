// Numbers for people.

const kMissing = '–';

/** As many decimals as say something; very large and small ones with an exponent. */
function number(value, digits = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return kMissing;
  if (Number.isInteger(value) && Math.abs(value) < 1e9) return String(value);
  const size = Math.abs(value);
  if (size >= 1e6 || (size > 0 && size < 1e-4)) return value.toExponential(digits - 1);
  return String(Number(value.toPrecision(digits)));
}

function fixed(value, decimals) {
  return value === null || value === undefined || !Number.isFinite(value) ? kMissing : value.toFixed(decimals);
}

function seconds(value) {
  if (!Number.isFinite(value)) return kMissing;
  if (value < 120) return `${value < 10 ? value.toFixed(2) : value.toFixed(1)} s`;
  const minutes = Math.floor(value / 60);
  return minutes < 120 ? `${minutes} min ${Math.round(value % 60)} s`
    : `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}

/** A length that may be very short. */
function metres(value) {
  if (value === null || value === undefined || !Number.isFinite(value)) return kMissing;
  if (Math.abs(value) < 0.1) return `${(1000 * value).toFixed(1)} mm`;
  return `${value.toFixed(2)} m`;
}

function percent(value) { return `${(100 * value).toFixed(1)} %`; }

/** Whatever metrics.json may hold. */
function anyValue(value) {
  if (typeof value === 'number') return number(value, 5);
  if (value === null || value === undefined) return kMissing;
  if (typeof value === 'string') return value === '' ? kMissing : value;
  return JSON.stringify(value);
}
