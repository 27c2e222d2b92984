// A person as the service writes one.

/** One attribute of a recipe, as the service describes it. */
export interface AttributeInfo {
  default: number | string;
  /** Lowest and highest value of a number. */
  range?: [number, number];
  /** Words to choose from. */
  choices?: string[];
}

export type Recipe = Record<string, number | string>;
