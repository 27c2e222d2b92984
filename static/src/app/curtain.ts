// The curtain over the stage, until the first face is there.

const element = (): HTMLElement => document.getElementById('curtain')!;

export const curtain = {
  element,
  get isOpen(): boolean {
    return element().classList.contains('open');
  },
  open(): void {
    element().classList.add('open');
  },
  close(): void {
    element().classList.remove('open');
  },
};
